//! The contracts of wall motions and boundaries: ours keep them, and each planted fault is caught.

mod boundaries;
mod containers;
mod engine;
mod fingerprints;
mod motions;
mod names;
