//! Boundaries: the container in exact numbers; the contract, which each planted fault breaks; names and
//! fingerprints.

mod areas;
mod checks;
mod container;
mod contract;
mod fast_parts;
mod files;
mod fingerprints;
mod names;
mod obstacles;
mod patches;
mod periodic_parts;
mod planted;
mod touches;
mod vessels;
