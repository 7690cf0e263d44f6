//! Parts that a user of the library writes with the public API alone: a rule, a wall motion, a scheduler, an
//! observable, observers and a boundary.

pub mod angular_momentum;
pub mod drum;
pub mod hardest_impacts;
pub mod lazy_heap;
pub mod two_sines;
pub mod viscoelastic;
