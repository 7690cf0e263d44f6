//! Violations of the laws, as errors.

use thiserror::Error;

use crate::collision::{Contact, Impulse, Regime};

/// A law that a rule breaks, with the contact and the impulse that show it.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the impulse {impulse} {fault} ({contact})")]
#[non_exhaustive]
pub struct Violation {
    /// The fault of the impulse.
    pub fault: Fault,
    /// The contact.
    pub contact: Box<Contact>,
    /// The impulse that was given.
    pub impulse: Impulse,
}

/// A fault of an impulse.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Fault {
    /// A component of the impulse is infinite or not a number.
    #[error("is not finite")]
    NotFinite,
    /// The partners still approach after the collision.
    #[error("leaves the surfaces closing, at speed {closing_speed:?}")]
    StillClosing {
        /// Closing speed after the collision.
        closing_speed: f64,
    },
    /// The collision adds kinetic energy.
    #[error("gains the energy {energy_change:?}")]
    EnergyGained {
        /// Change of kinetic energy.
        energy_change: f64,
    },
    /// The tangential impulse speeds up the slip, or reverses it and makes it faster.
    #[error("makes the slip faster: {slip_speed:?}")]
    SlipSpedUp {
        /// Slip speed after the collision.
        slip_speed: f64,
    },
    /// The tangential impulse is larger than static friction can hold.
    #[error("leaves the friction cone: {limit:?} is the most along the tangent")]
    OutsideFrictionCone {
        /// Static friction times the normal impulse.
        limit: f64,
    },
    /// The rule gives two answers to the same contact.
    #[error("is another when asked for again: {later}, {:?}", later.regime())]
    NotRepeatable {
        /// The impulse that was given later.
        later: Impulse,
    },
}

/// Tells whether two impulses are the same to the bit.
pub(super) fn same(left: Impulse, right: Impulse) -> bool {
    let bits = |impulse: Impulse| -> ([u64; 3], Regime) {
        let numbers = [impulse.normal(), impulse.tangential(), impulse.couple()];
        (numbers.map(f64::to_bits), impulse.regime())
    };
    bits(left) == bits(right)
}
