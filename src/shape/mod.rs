//! Convex geometry that knows no body: solids, hulls, meshes, their moments and surfaces, and where two of them meet.

mod axis;
pub mod band;
pub mod capsule;
pub mod closest;
pub mod convex;
pub mod cuboid;
pub mod cylinder;
pub mod ellipsoid;
mod gjk;
pub mod hull;
mod manifold;
pub mod mesh;
pub mod moments;
pub mod pair;
mod placed;
pub mod solid;
pub mod sphere;
pub mod triangles;
