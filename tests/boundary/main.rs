//! Boundaries: the container in exact numbers; the contract of containers and parts; areas, files and
//! fingerprints.

mod areas;
mod checks;
mod container;
mod contract;
mod fast_parts;
mod files;
mod fingerprints;
mod obstacles;
mod patches;
mod periodic_parts;
mod touches;
mod vessels;
