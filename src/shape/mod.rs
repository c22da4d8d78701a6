//! Convex geometry that knows no body: solids, hulls, meshes, their moments and surfaces, and where two of them meet.

pub mod area;
mod axis;
pub mod closest;
mod gjk;
pub mod hull;
mod manifold;
pub mod mesh;
pub mod moments;
pub mod pair;
mod placed;
pub mod solid;
pub mod triangles;
