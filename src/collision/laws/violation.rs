//! Violations of the laws, as errors.

use thiserror::Error;

use crate::collision::{Contact, Impulse, Regime};

/// A law that a rule breaks, with the contact and the impulse that show it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum Violation {
    /// A component of the impulse is infinite or not a number.
    #[error("the impulse {impulse} is not finite ({contact})")]
    NotFinite {
        /// The contact.
        contact: Contact,
        /// The impulse that was given.
        impulse: Impulse,
    },
    /// The partners still approach after the collision.
    #[error("after the impulse {impulse} the surfaces still close, at speed {closing_speed:?} ({contact})")]
    StillClosing {
        /// Closing speed after the collision.
        closing_speed: f64,
        /// The contact.
        contact: Contact,
        /// The impulse that was given.
        impulse: Impulse,
    },
    /// The collision adds kinetic energy.
    #[error("the impulse {impulse} gains the energy {energy_change:?} ({contact})")]
    EnergyGained {
        /// Change of kinetic energy.
        energy_change: f64,
        /// The contact.
        contact: Contact,
        /// The impulse that was given.
        impulse: Impulse,
    },
    /// The tangential impulse speeds up the slip, or reverses it and makes it faster.
    #[error("the impulse {impulse} makes the slip faster: {slip_speed:?} ({contact})")]
    SlipSpedUp {
        /// Slip speed after the collision.
        slip_speed: f64,
        /// The contact.
        contact: Contact,
        /// The impulse that was given.
        impulse: Impulse,
    },
    /// The tangential impulse is larger than static friction can hold.
    #[error(
        "the impulse {impulse} leaves the friction cone: {limit:?} is the most along the tangent ({contact})"
    )]
    OutsideFrictionCone {
        /// Static friction times the normal impulse.
        limit: f64,
        /// The contact.
        contact: Contact,
        /// The impulse that was given.
        impulse: Impulse,
    },
    /// The rule gives two answers to the same contact.
    #[error(
        "the same contact had the impulse {impulse} ({:?}), later {later} ({:?}): {contact}",
        impulse.regime(), later.regime()
    )]
    NotRepeatable {
        /// The impulse that was given later.
        later: Impulse,
        /// The contact.
        contact: Contact,
        /// The impulse that was given first.
        impulse: Impulse,
    },
}

impl Violation {
    /// Returns the contact for which the law is broken.
    pub const fn contact(&self) -> &Contact {
        match self {
            Self::NotFinite { contact, .. }
            | Self::StillClosing { contact, .. }
            | Self::EnergyGained { contact, .. }
            | Self::SlipSpedUp { contact, .. }
            | Self::OutsideFrictionCone { contact, .. }
            | Self::NotRepeatable { contact, .. } => contact,
        }
    }

    /// Returns the impulse that breaks the law.
    pub const fn impulse(&self) -> Impulse {
        match self {
            Self::NotFinite { impulse, .. }
            | Self::StillClosing { impulse, .. }
            | Self::EnergyGained { impulse, .. }
            | Self::SlipSpedUp { impulse, .. }
            | Self::OutsideFrictionCone { impulse, .. }
            | Self::NotRepeatable { impulse, .. } => *impulse,
        }
    }
}

/// Tells whether two impulses are the same to the bit.
pub(super) fn same(left: Impulse, right: Impulse) -> bool {
    let bits = |impulse: Impulse| -> (u64, u64, Regime) {
        (impulse.normal().to_bits(), impulse.tangential().to_bits(), impulse.regime())
    };
    bits(left) == bits(right)
}
