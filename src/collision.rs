//! Collision rules: the outcome when two disks, or a disk and a wall, touch.
//!
//! A rule is a pure function from a [`Contact`] (how fast the surfaces close and slip, the masses that
//! resist, the kinds and radii of the partners) to an [`Impulse`]. The engine applies the impulse to one
//! partner at the contact point, and its opposite to the other. Momentum, angular momentum and Galilean
//! invariance therefore hold for *any* rule. A rule can only get energy, separation and friction wrong, and
//! [`laws`] checks those. A wall is a partner of infinite mass, unless it reacts, so one rule serves disks
//! and walls.
//!
//! | rule | energy loss | source |
//! |---|---|---|
//! | [`Frictional`] | normal and tangential restitution, static and dynamic friction | paper, Eqs. (1)–(5) |
//! | [`Smooth`] | normal restitution only | paper, Eq. (8) |
//! | [`Rough`] | normal and tangential restitution, no Coulomb limit | paper, Eqs. (3), (4) |
//! | [`SpeedDependent`] | normal restitution that falls with speed, friction | Bizon et al. 1998 |
//! | [`Elastic`] | none | |
//! | [`ContactDuration`] | an adaptor: contacts soon after others lose nothing | Luding and McNamara 1998 |
//! | [`ElasticBelow`] | an adaptor: slow contacts lose nothing | a cutoff in many codes |
//! | [`LeastRebound`] | an adaptor: surfaces never part too slowly, which can add energy | |
//! | [`RollingFriction`] | an adaptor: a couple slows the relative spin | Iwashita and Oda 1998 |
//! | [`RulesByKind`] | a table: one rule for each pair of kinds | |
//! | [`KnownRule`] | any of the above, as one type that files can hold | |
//! | [`from_fn`] | your rule, as a closure | |
//!
//! # Custom rules
//! A rule can compute the normal impulse itself and leave the tangential one to [`Friction`]. The example is
//! a viscoelastic sphere: its restitution is $`1 - C v^{1/5}`$ to first order, here written as
//! $`1/(1 + C v^{1/5})`$, which stays positive:
//!
//! ```
//! use granular_edmd::collision::{CollisionRule, Contact, Friction, Impulse, laws};
//!
//! struct Viscoelastic {
//!     loss: f64,
//!     friction: Friction,
//! }
//!
//! impl CollisionRule for Viscoelastic {
//!     fn impulse(&self, contact: &Contact) -> Impulse {
//!         // `libm` has the same bits on every platform; `powf` of the standard library does not.
//!         let restitution = 1.0 / (1.0 + self.loss * libm::pow(contact.closing_speed(), 0.2));
//!         self.friction.impulse(contact, contact.normal_impulse(restitution))
//!     }
//! }
//!
//! let rule = Viscoelastic { loss: 0.3, friction: Friction::from_inelasticity(0.25, 0.5)? };
//! laws::check(&rule, &laws::Promises::new().with_friction(0.5))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod contact;
mod encounter;
mod frictional;
mod known;
pub mod laws;
mod remedies;
mod without_friction;

pub use contact::{Contact, Impulse, Regime};
pub(crate) use encounter::momentum;
pub(crate) use encounter::{Body, Material, after, collide_after, collide_bodies, contact_of, meeting};
pub use encounter::{Encounter, WallEncounter, collide, collide_with_wall};
pub use frictional::{Friction, Frictional, SpeedDependent};
pub use known::{FromFn, KnownRule, RulesByKind, from_fn};
pub use remedies::{ContactDuration, ElasticBelow, LeastRebound, RollingFriction, TangentialResponse};
pub use without_friction::{Elastic, Rough, Smooth};

use std::sync::Arc;

use crate::Fingerprint;
use crate::forward::forward;

/// The law of a collision, which turns a contact into an impulse.
///
/// # Contract
/// The engine calls [`Self::impulse`] at least once for each collision that the rule decides, between disks
/// or with a wall; to prepare or to diagnose a run, it may ask again, and about other contacts. The engine
/// guarantees the following about the contact:
/// - the closing speed is finite and not negative; it may be zero;
/// - the slip speed and the relative spin are finite, of either sign or zero;
/// - the masses are finite and positive, the tangential one not above the normal one; masses and radii of
///   disks are between $`10^{-30}`$ and $`10^{30}`$;
/// - the radius of a wall is infinite if it is straight, negative if it is hollow, and never zero;
/// - in a collision with a wall, partner 2 is the wall. In a collision of two disks, either may be partner 1.
///
/// The rule guarantees:
/// 1. The same contact gets the same impulse every time, to the bit; a rule that needs history finds it in
///    the contact. Otherwise, a run would depend on earlier calls, and a resumed run would differ.
/// 2. The impulse is finite. Otherwise, the run ends with an error that names the partners and the contact.
/// 3. The surfaces no longer close after the collision. Otherwise, they collide again immediately, until the
///    run ends as stalled.
/// 4. The collision does not increase the energy of the relative motion of the surfaces and of the relative
///    spin, unless the rule is meant to drive. Otherwise, the system heats up unnoticed.
/// 5. An exchange of the partners leaves the physics unchanged. The contact with kinds and radii in the other
///    order, and with the opposite relative spin and response, gets the same normal and tangential impulse,
///    and the opposite couple. Otherwise, a trajectory depends on the order of the disks in a list.
/// 6. The mirror image of a contact gives the mirror image of the impulse. The contact with the opposite slip
///    and relative spin gets the same normal impulse, and the opposite tangential impulse and couple. A rule
///    for disks that are not symmetric may differ.
///
/// All of this holds up to rounding: a relative error of $`10^{-12}`$ of the speeds and energies.
/// [`laws::check`] tests it. Its `promises` say which of promises 4 to 6 a rule does not keep, and which
/// additional promises it keeps: friction and rolling friction within their limits. `docs/validation.md` says
/// which planted faults the check finds.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a collision rule",
    label = "the trait `CollisionRule` is not implemented for `{Self}`",
    note = "wrap a closure in `granular_edmd::collision::from_fn`, with its argument written as `|contact: &Contact|`"
)]
pub trait CollisionRule {
    /// Returns the impulse on the first partner; the second receives its opposite.
    fn impulse(&self, contact: &Contact) -> Impulse;

    /// Returns a number that identifies the rule, so that a checkpoint notices when a run is resumed under
    /// another rule.
    ///
    /// Rules with equal fingerprints must give equal impulses. A rule without a fingerprint is not compared.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }

    /// Returns the rule as data if it is a rule of this crate. A rule that wraps other rules, or a table of
    /// rules, must be made of such rules only.
    ///
    /// Files of walls hold their rules in this form. A custom rule has none.
    fn known(&self) -> Option<KnownRule> {
        None
    }
}

forward! { CollisionRule for [&T, Box<T>, Arc<T>] {
    fn impulse(&self, contact: &Contact) -> Impulse;
    fn fingerprint(&self) -> Option<Fingerprint>;
    fn known(&self) -> Option<KnownRule>;
}}
