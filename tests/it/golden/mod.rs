//! Files kept in the repository that the program must make again.

mod gallery;
