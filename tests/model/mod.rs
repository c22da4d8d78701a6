//! Meshes, mass properties, containers, start states.

mod container;
mod mass;
mod mesh;
mod start;
