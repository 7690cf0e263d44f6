//! Checks of the laws that a collision rule can break, for custom rules.
//!
//! Momentum, angular momentum and Galilean invariance hold by construction, because the engine applies any
//! impulse and its opposite at the contact point. The rule is responsible for separation, energy and
//! friction, and for symmetry.
//!
//! [`check`] calls a rule in half a million contacts, the same contacts for the same seed, and takes one line
//! in a unit test:
//!
//! ```
//! use granular_edmd::collision::laws::{self, Promises};
//! use granular_edmd::collision::{Contact, Frictional, Impulse, from_fn};
//!
//! laws::check(&Frictional::from_inelasticity(0.1, 0.1, 0.3)?, &Promises::new().with_friction(0.3))?;
//!
//! let glue = from_fn(|_: &Contact| Impulse::new(0.0, 0.0));
//! let violation = laws::check(&glue, &Promises::new()).unwrap_err();
//! assert_eq!(violation.law(), "separation");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! To check single contacts, use [`check_impulse`], [`check_friction_opposes_slip`] and
//! [`check_friction_cone`]; to compare the fingerprints of two rules, [`check_fingerprints`].
//! With the feature `proptest`, the module `strategies` makes random contacts.

mod contacts;

use std::any::type_name;

use self::contacts::{contacts_of_all_kinds, random_contacts};
use crate::collision::{CollisionRule, Contact, Impulse, Regime};
use crate::error::require;
use crate::{Kind, Violation};
pub use contacts::hostile_contacts;

/// Allowed rounding in each law, relative to the speeds and energies of the contact.
const ROUNDING: f64 = 1e-12;

/// Smallest product whose relative rounding error is bounded. Smaller numbers have fewer digits.
const LEAST: f64 = f64::MIN_POSITIVE;

const PART: &str = "collision rule";

/// Checks that `impulse` is possible in `contact`: it is finite, it separates the surfaces, and it adds no
/// energy, even through its couple.
///
/// # Errors
/// The first broken law: "finite", "separation" or "energy".
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
/// assert!(laws::check_impulse(&contact, Impulse::new(0.8, 0.0)).is_ok());
/// let violation = laws::check_impulse(&contact, Impulse::new(0.2, 0.0)).unwrap_err();
/// assert!(violation.found().contains("leaves the surfaces closing, at speed 0.6"));
/// ```
pub fn check_impulse(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    check_separation(contact, impulse)?;
    let change = impulse.energy_change(contact);
    let mut available = contact.available_energy();
    if impulse.couple() != 0.0 {
        let spin = contact.relative_spin();
        available += 0.5 * contact.spin_inertia() * spin * spin;
    }
    require!(PART, "energy", change <= ROUNDING * available + LEAST;
        "the impulse {impulse} gains the energy {change:?} ({contact})");
    Ok(())
}

fn check_finite(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let numbers = [impulse.normal(), impulse.tangential(), impulse.couple()];
    let are_finite = numbers.iter().all(|number| number.is_finite());
    require!(PART, "finite", are_finite; "the impulse {impulse} is not finite ({contact})");
    Ok(())
}

/// Checks all laws except the law of energy.
fn check_separation(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    check_finite(contact, impulse)?;
    let speed = impulse.closing_speed_after(contact);
    let rounding = rounding_of(contact.closing_speed(), contact.normal_mass());
    require!(PART, "separation", speed <= rounding;
        "the impulse {impulse} leaves the surfaces closing, at speed {speed:?} ({contact})");
    Ok(())
}

/// Checks that the tangential impulse can be friction: it slows the slip, and at most reverses it.
///
/// A rule may add to the slip and still lose energy, if it takes that energy from the normal direction.
/// [`check_impulse`] allows this, but friction never does it. The check ignores a couple, which acts after
/// friction.
///
/// # Errors
/// If the impulse pushes along the slip, or the slip is faster after the collision.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
/// assert!(laws::check_friction_opposes_slip(&contact, Impulse::new(0.8, 0.1)).is_ok());
/// assert!(laws::check_friction_opposes_slip(&contact, Impulse::new(0.8, -0.1)).is_err());
/// ```
pub fn check_friction_opposes_slip(contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
    let slip = impulse.with_couple(0.0).slip_speed_after(contact);
    // The sign is exact, however small the impulse is compared with the slip.
    let opposes = opposes(impulse.tangential(), contact.slip_speed());
    let bound = contact.slip_speed().abs() + rounding_of(contact.slip_speed(), contact.tangential_mass());
    require!(PART, "opposed slip", opposes && slip.abs() <= bound;
        "the impulse {impulse} makes the slip faster: {slip:?} ({contact})");
    Ok(())
}

/// Checks that the impulse lies in the cone of friction, |Δ_t| ≤ κ_s Δ_n.
///
/// # Errors
/// If the impulse lies outside the cone.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse, laws};
/// let contact = Contact::new(1.0, 0.5, 0.5, 0.5 / 3.0);
/// assert!(laws::check_friction_cone(&contact, Impulse::new(0.8, 0.2), 0.25).is_ok());
/// assert!(laws::check_friction_cone(&contact, Impulse::new(0.8, 0.3), 0.25).is_err());
/// ```
pub fn check_friction_cone(
    contact: &Contact,
    impulse: Impulse,
    static_friction: f64,
) -> Result<(), Violation> {
    let limit = static_friction * impulse.normal();
    let is_inside = impulse.tangential().abs() <= limit * (1.0 + ROUNDING) + LEAST;
    require!(PART, "friction cone", is_inside;
        "the impulse {impulse} leaves the friction cone: {limit:?} is the most along the tangent ({contact})");
    Ok(())
}

/// Checks that the couple can be rolling friction: it is at most μ_r Δ_n R, it slows the relative spin that
/// friction leaves, and it does not reverse it.
fn check_rolling(contact: &Contact, impulse: Impulse, coefficient: f64) -> Result<(), Violation> {
    let limit = coefficient * impulse.normal() * contact.effective_radius();
    let couple = impulse.couple();
    let is_inside = couple.abs() <= limit * (1.0 + ROUNDING) + LEAST;
    require!(PART, "rolling friction", is_inside;
        "the impulse {impulse} is beyond its limit {limit:?} ({contact})");
    let spin = impulse.with_couple(0.0).relative_spin_after(contact);
    let least = rounding_of(contact.relative_spin(), contact.spin_inertia())
        + ROUNDING * (contact.spin_response() * impulse.tangential()).abs();
    let stops = (contact.spin_inertia() * spin).abs() * (1.0 + ROUNDING);
    let slows = opposes(couple, spin) && couple.abs() <= stops;
    require!(PART, "rolling friction", slows || couple.abs() <= contact.spin_inertia() * least;
        "the impulse {impulse} does not slow the spin {spin:?} that friction leaves ({contact})");
    Ok(())
}

/// Returns whether an impulse is zero, or acts against this speed.
fn opposes(impulse: f64, speed: f64) -> bool {
    impulse == 0.0 || impulse.signum() * speed > 0.0
}

/// Returns the rounding error of a speed after an impulse on this mass. The impulse itself is uncertain by
/// [`LEAST`].
fn rounding_of(speed: f64, mass: f64) -> f64 {
    ROUNDING * speed.abs() + LEAST / mass
}

/// Kinds of the partners in a check, in all pairs, unless the promises name others.
const KINDS: [Kind; 23] = {
    let mut kinds = [Kind::DEFAULT; 23];
    let mut number = 0;
    while number < 20 {
        kinds[number as usize] = Kind::new(number);
        number += 1;
    }
    (kinds[20], kinds[21], kinds[22]) = (Kind::new(255), Kind::new(256), Kind::new(65_000));
    kinds
};

/// Step between two contacts in the last pass, a prime that divides no number of contacts in a check.
const STRIDE: usize = 7919;

/// The promises of a rule. Every rule also promises finite impulses that separate the surfaces and repeat to
/// the bit, and the same physics for partners in either order and for the mirror image.
///
/// ```
/// use granular_edmd::collision::laws::{Promises, check};
/// use granular_edmd::collision::{Elastic, RollingFriction, Rough, Smooth};
///
/// check(&Smooth::from_inelasticity(0.2)?, &Promises::new().with_friction(0.0))?;
/// check(&Rough::from_inelasticity(0.2, 0.1)?, &Promises::new().with_opposed_slip())?;
/// check(&RollingFriction::new(Elastic, 0.3)?, &Promises::new().with_rolling_friction(0.3))?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Promises {
    energy_gain: bool,
    opposed_slip: bool,
    static_friction: Option<f64>,
    rolling_friction: Option<f64>,
    mirror: bool,
    kinds: Option<&'static [Kind]>,
    seed: u64,
}

impl Default for Promises {
    fn default() -> Self {
        Self::new()
    }
}

impl Promises {
    /// Creates the promise that a collision gains no energy. It promises nothing about the tangential
    /// impulse.
    pub const fn new() -> Self {
        Self {
            energy_gain: false,
            opposed_slip: false,
            static_friction: None,
            rolling_friction: None,
            mirror: true,
            kinds: None,
            seed: 1,
        }
    }

    /// Returns the same promises, with Coulomb friction: the impulse stays in the cone of this coefficient
    /// κ_s, and opposes the slip.
    pub const fn with_friction(self, static_friction: f64) -> Self {
        Self { opposed_slip: true, static_friction: Some(static_friction), ..self }
    }

    /// Returns the same promises, with a tangential impulse that opposes the slip, whether or not it stays
    /// within a cone.
    pub const fn with_opposed_slip(self) -> Self {
        Self { opposed_slip: true, ..self }
    }

    /// Returns the same promises, with rolling friction of this coefficient μ_r: the couple is at most
    /// μ_r Δ_n R with the effective radius R, and slows the spin that friction leaves without reversing it.
    pub const fn with_rolling_friction(self, coefficient: f64) -> Self {
        Self { rolling_friction: Some(coefficient), ..self }
    }

    /// Returns the same promises for a rule that drives: energy may be gained.
    pub const fn with_energy_gain(self) -> Self {
        Self { energy_gain: true, ..self }
    }

    /// Returns the same promises for a rule that acts differently on the mirror image of a contact, as one
    /// for chiral grains does.
    pub const fn with_handedness(self) -> Self {
        Self { mirror: false, ..self }
    }

    /// Returns the same promises for disks of these kinds only; the default is all kinds.
    ///
    /// Name the kinds on which a rule depends: all contacts are then between these kinds. Otherwise, most
    /// pairs of kinds meet in one ordinary contact only, which does not show a fault at other speeds.
    ///
    /// ```
    /// use granular_edmd::Kind;
    /// use granular_edmd::collision::laws::{Promises, check};
    /// use granular_edmd::collision::{RulesByKind, Smooth};
    ///
    /// const SAND: Kind = Kind::new(40);
    /// let (hard, soft) = (Smooth::from_inelasticity(0.0)?, Smooth::from_inelasticity(0.1)?);
    /// let rules = RulesByKind::new(hard).with(SAND, SAND, soft);
    /// check(&rules, &Promises::new().with_kinds(const { &[Kind::DEFAULT, SAND] }))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn with_kinds(self, kinds: &'static [Kind]) -> Self {
        Self { kinds: Some(kinds), ..self }
    }

    /// Returns the same promises, which [`check`] tests with other random contacts.
    pub const fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Checks that `impulse` keeps these promises.
    ///
    /// # Errors
    /// The first broken promise.
    pub fn check(&self, contact: &Contact, impulse: Impulse) -> Result<(), Violation> {
        // First, since an impulse that is no number breaks the other laws, too, and friction of the wrong
        // sign gains energy.
        check_finite(contact, impulse)?;
        if self.opposed_slip {
            check_friction_opposes_slip(contact, impulse)?;
        }
        if self.energy_gain { check_separation(contact, impulse) } else { check_impulse(contact, impulse) }?;
        if let Some(static_friction) = self.static_friction {
            check_friction_cone(contact, impulse, static_friction)?;
        }
        if let Some(coefficient) = self.rolling_friction {
            check_rolling(contact, impulse, coefficient)?;
        }
        Ok(())
    }

    /// Checks the impulse of a rule in a contact, in the contact with partners exchanged, and, if `mirror`,
    /// in its mirror image.
    fn check_answer(
        &self,
        rule: &dyn CollisionRule,
        contact: &Contact,
        mirror: bool,
    ) -> Result<(), Violation> {
        let impulse = rule.impulse(contact);
        self.check(contact, impulse)?;
        let is_between_disks = contact.radii()[1] > 0.0 && !contact.kinds().contains(&Kind::WALL);
        if is_between_disks && contact.radii()[1].is_finite() {
            let other = rule.impulse(&exchanged(contact));
            check_same(contact, impulse, other, 1.0, "exchange of partners")?;
        }
        if mirror {
            check_same(contact, impulse, rule.impulse(&mirrored(contact)), -1.0, "mirror image")?;
        }
        Ok(())
    }

    /// Returns the contacts of a check, with kinds of these promises.
    fn contacts(&self) -> impl Iterator<Item = Contact> + '_ {
        let kinds = self.kinds.unwrap_or(&KINDS);
        let named = move |kind: Kind| match kind {
            Kind::WALL => kind,
            _ => kinds.get(usize::from(kind.number()) % kinds.len().max(1)).copied().unwrap_or(kind),
        };
        let hostile = hostile_contacts().map(move |contact| contact.with_kinds(contact.kinds().map(named)));
        hostile.chain(random_contacts(self.seed, kinds))
    }

    /// Returns ordinary contacts of all kinds, unless the promises name kinds.
    fn contacts_of_kinds(&self) -> impl Iterator<Item = Contact> + use<> {
        self.kinds.is_none().then(contacts_of_all_kinds).into_iter().flatten()
    }
}

/// Checks that `rule` keeps its promises, and that it returns the same impulses when it is called again in
/// other orders.
///
/// The contacts are all [`hostile_contacts`], and twelve thousand random ones between their extremes: between
/// disks and with straight, convex and hollow walls, with relative spins, mass ratios up to 10⁶ and infinite
/// masses, and last collisions at any time. Each is also tried with the partners exchanged and as its mirror
/// image. Each kind has an ordinary contact with the same kind, with the default kind and with a wall, and is
/// the kind of a wall that a disk of the default kind hits; so has each pair of kinds below 256. These are
/// also tried with the partners exchanged. The page "Validation" says which planted faults the check finds.
///
/// # Errors
/// The first broken promise, with the contact.
pub fn check<R: CollisionRule + ?Sized>(rule: &R, promises: &Promises) -> Result<(), Violation> {
    // A rule of any type, so that the checks are compiled once.
    let rule: &dyn CollisionRule = &rule;
    check_equal_answers(rule, promises)?;
    promises.contacts().try_for_each(|contact| promises.check_answer(rule, &contact, promises.mirror))?;
    // These are many, and their mirror images would show nothing else.
    promises.contacts_of_kinds().try_for_each(|contact| promises.check_answer(rule, &contact, false))
}

/// Checks that a rule returns the same impulses when it is called again in other orders.
///
/// A rule with a memory would break other laws, too, for a reason that they do not name, so this law is the
/// first. The rule remembers other contacts in each pass.
fn check_equal_answers(rule: &dyn CollisionRule, promises: &Promises) -> Result<(), Violation> {
    let answers: Vec<_> = promises.contacts().map(|contact| (contact, rule.impulse(&contact))).collect();
    let count = answers.len();
    for index in (0..count).rev().chain((0..count).map(|step| step * STRIDE % count)) {
        let (contact, impulse) = answers[index];
        let later = rule.impulse(&contact);
        require!(PART, "repeatable", bits(impulse) == bits(later);
            "the impulse {impulse} changes when the rule is called again: {later}, {:?} ({contact})",
            later.regime());
    }
    Ok(())
}

/// Checks that two rules with different impulses have different fingerprints, and that two rules of one type
/// with equal impulses in all contacts of [`check`] have the same fingerprint. Rules without a fingerprint
/// are not compared.
///
/// Pairs of different kinds are compared up to kind 255, most of them in two contacts. The check cannot see
/// other differences. If two such rules are of one type, the check refuses different fingerprints. Rules of
/// two types may act alike and have different fingerprints.
///
/// # Errors
/// If the fingerprints contradict the impulses.
///
/// ```
/// use granular_edmd::collision::{Smooth, laws};
/// let of = Smooth::from_inelasticity;
/// laws::check_fingerprints(&of(0.1)?, &of(0.2)?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_fingerprints<R, S>(first: &R, second: &S) -> Result<(), Violation>
where
    R: CollisionRule + ?Sized,
    S: CollisionRule + ?Sized,
{
    let differ = |contact: &Contact| bits(first.impulse(contact)) != bits(second.impulse(contact));
    let promises = Promises::new();
    let mut contacts = promises.contacts().chain(promises.contacts_of_kinds());
    let difference = contacts.find(differ).map(|contact| format!("in {contact}"));
    let (Some(one), Some(other)) = (first.fingerprint(), second.fingerprint()) else { return Ok(()) };
    if let Some(difference) = difference {
        require!(PART, "fingerprint", one != other;
            "two rules have the fingerprint {one}, but differ {difference}");
    } else if type_name::<R>() == type_name::<S>() {
        require!(PART, "fingerprint", one == other;
            "rules of one type that are alike in every contact have the fingerprints {one} and {other}");
    }
    Ok(())
}

/// Returns the same contact with the partners exchanged.
fn exchanged(contact: &Contact) -> Contact {
    let ([first, second], [one, other]) = (contact.kinds(), contact.radii());
    contact.with_kinds([second, first]).with_radii([other, one]).with_spin(
        0.0 - contact.relative_spin(),
        contact.spin_inertia(),
        0.0 - contact.spin_response(),
    )
}

fn mirrored(contact: &Contact) -> Contact {
    Contact::new(
        contact.closing_speed(),
        0.0 - contact.slip_speed(),
        contact.normal_mass(),
        contact.tangential_mass(),
    )
    .with_kinds(contact.kinds())
    .with_radii(contact.radii())
    .with_time_since_last_collision(contact.time_since_last_collision())
    .with_spin(0.0 - contact.relative_spin(), contact.spin_inertia(), contact.spin_response())
}

/// Checks that an impulse equals another one up to the given signs. The couple changes its sign in both
/// cases.
fn check_same(
    contact: &Contact,
    impulse: Impulse,
    other: Impulse,
    sign: f64,
    law: &'static str,
) -> Result<(), Violation> {
    let close = |one: f64, other: f64, scale: f64| {
        (one - other).abs() <= ROUNDING * (one.abs() + other.abs() + scale.abs()) + LEAST
    };
    let turning = contact.spin_inertia() * contact.relative_spin();
    let expected = Impulse::new(impulse.normal(), sign * impulse.tangential()).with_couple(-impulse.couple());
    let is_same = close(expected.normal(), other.normal(), 0.0)
        && close(expected.tangential(), other.tangential(), impulse.normal())
        && close(expected.couple(), other.couple(), turning);
    let change = if sign < 0.0 { "tangential impulse and couple change" } else { "the couple changes" };
    require!(PART, law, is_same;
        "the impulse {impulse} should be {expected} in the {law}, where {change} sign, but is {other} there ({contact})");
    Ok(())
}

/// Returns the bits of an impulse, and its regime.
fn bits(impulse: Impulse) -> ([u64; 3], Regime) {
    let numbers = [impulse.normal(), impulse.tangential(), impulse.couple()];
    (numbers.map(f64::to_bits), impulse.regime())
}
