//! Collision rules: what happens when two disks, or a disk and a wall, touch.
//!
//! A rule is a pure function from a [`Contact`] (how fast the surfaces close and slip, and the masses that resist)
//! to an [`Impulse`]. The engine applies the impulse to one partner and its opposite to the other at the contact
//! point, so momentum, angular momentum and Galilean invariance hold for *any* rule; what a rule can get wrong is
//! energy and separation, and [`laws`] checks those. A wall is a partner of infinite mass: one rule serves both.
//!
//! | rule | energy loss | source |
//! |---|---|---|
//! | [`Frictional`] | normal and tangential restitution, static and dynamic friction | paper, Eqs. (1)–(5) |
//! | [`Smooth`] | normal restitution only | paper, Eq. (8) |
//! | [`Rough`] | normal and tangential restitution, no Coulomb limit | paper, Eqs. (3), (4) |
//! | [`Elastic`] | none | |
//! | [`ContactDuration`] | an adaptor: repeated contacts within a set time lose nothing | Luding and McNamara 1998 |
//! | [`from_fn`] | yours, as a closure | |
//!
//! # A rule of your own
//! ```
//! use granular_edmd::collision::{CollisionRule, Contact, Impulse, laws};
//!
//! /// Restitution that falls with the speed of the impact.
//! struct Viscoelastic {
//!     loss: f64,
//! }
//!
//! impl CollisionRule for Viscoelastic {
//!     fn impulse(&self, contact: &Contact) -> Impulse {
//!         let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed().powf(0.2));
//!         Impulse::new((1.0 + restitution) * contact.normal_mass() * contact.closing_speed(), 0.0)
//!     }
//! }
//!
//! let contact = Contact::new(2.0, 0.5, 0.5, 1.0 / 6.0);
//! let impulse = Viscoelastic { loss: 0.1 }.impulse(&contact);
//! laws::check(&contact, impulse)?;
//! # Ok::<(), laws::Violation>(())
//! ```

mod contact;
mod contact_duration;
mod elastic;
mod encounter;
mod frictional;
mod from_fn;
mod impulse;
pub mod laws;
mod rough;
mod smooth;

pub use contact::Contact;
pub use contact_duration::{ContactDuration, TangentialResponse};
pub use elastic::Elastic;
pub(crate) use encounter::{Body, Material, meet};
pub use encounter::{collide, collide_with_wall};
pub use frictional::Frictional;
pub use from_fn::{FromFn, from_fn};
pub use impulse::{Impulse, Regime};
pub use rough::Rough;
pub use smooth::Smooth;

use crate::ParameterError;
use crate::quantity::accept;

/// What happens when two surfaces touch.
///
/// # Contract
/// `impulse` is called only for contacts that close (`closing_speed > 0`, by rounding sometimes `>= 0`). It returns
/// the same impulse for the same contact, every time: a rule that wants history finds it in the contact. The impulse
/// should leave the partners separating and should not add energy; [`laws::check`] tells whether it does.
pub trait CollisionRule {
    /// The impulse on the first partner; the second receives its opposite.
    fn impulse(&self, contact: &Contact) -> Impulse;
    fn explain(&self, contact: &Contact) -> Option<String> {
        let _ = contact;
        None
    }
    fn fingerprint(&self) -> Option<crate::Fingerprint> {
        None
    }
}

impl<T: CollisionRule + ?Sized> CollisionRule for &T {
    fn impulse(&self, contact: &Contact) -> Impulse {
        (**self).impulse(contact)
    }
}

impl<T: CollisionRule + ?Sized> CollisionRule for Box<T> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        (**self).impulse(contact)
    }
}

impl<T: CollisionRule + ?Sized> CollisionRule for std::sync::Arc<T> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        (**self).impulse(contact)
    }
}

/// Normal inelasticity `$q_n = (1 - r_n)/2$` (paper, Eq. (1)), in `[0, 1/2]`.
fn normal_inelasticity(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=0.5).contains(&value), "normal inelasticity", "in [0, 0.5]", value)
}

/// Tangential inelasticity `$q_t = (1 - r_t)/2$` (paper, Eq. (1)), in `[0, 1]`.
fn tangential_inelasticity(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=1.0).contains(&value), "tangential inelasticity", "in [0, 1]", value)
}

/// Inelasticity of a normal restitution in `[0, 1]`.
fn from_normal_restitution(value: f64) -> Result<f64, ParameterError> {
    accept((0.0..=1.0).contains(&value), "normal restitution", "in [0, 1]", value)?;
    Ok(0.5 * (1.0 - value))
}

/// Inelasticity of a tangential restitution in `[-1, 1]`.
fn from_tangential_restitution(value: f64) -> Result<f64, ParameterError> {
    accept((-1.0..=1.0).contains(&value), "tangential restitution", "in [-1, 1]", value)?;
    Ok(0.5 * (1.0 - value))
}
