//! Wall motions: the first touch with a disk, of which none is missed and none is early; the contract, which
//! each planted fault breaks.

mod engine;
mod first_touch;
mod motions;
