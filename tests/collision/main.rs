//! The laws of a collision, for every rule of the library: conservation, energy, friction, separation and
//! symmetry over hostile inputs; worked collisions; the checks for rules of users, against planted faults;
//! the contact-duration model; refused parameters and files.

mod conservation;
mod contact_duration;
mod elastic_below;
mod energy;
#[cfg(feature = "serde")]
mod files;
mod friction;
mod identity;
mod kinds;
mod kinematics;
mod least_rebound;
mod parameters;
mod planted;
mod rolling;
mod rules;
mod separation;
mod speed_dependent;
mod stick_slip;
mod symmetry;
mod violations;
mod wall;
mod worked;
