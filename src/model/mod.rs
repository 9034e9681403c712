//! Models: polygon meshes as they were read, and the scene made of them, which holds everything
//! that does not depend on the view.

pub mod mesh;

pub mod arrange;

pub mod topology;

pub mod triangulate;

pub mod diagnosis;

pub mod flush;

pub mod intersections;

pub mod bends;

mod planes;

pub mod creases;

pub mod smooth;

pub mod looseness;

pub mod scene;
