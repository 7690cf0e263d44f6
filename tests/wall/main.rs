//! Wall motions: the first touch with a disk, none missed and none early; the contract, which each planted fault breaks.

mod engine;
mod first_touch;
mod motions;
