//! Meshes, mass properties, containers, start states.

mod at_contact;
mod container;
mod mass;
mod mesh;
mod shapes;
mod start;
