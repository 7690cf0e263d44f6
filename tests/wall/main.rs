//! Wall motions: first touches with a disk, of which none is missed or early; the contract, which each
//! planted fault breaks; the roots that they rest on.

mod combined;
mod engine;
mod first_touch;
mod motions;
mod roots;
