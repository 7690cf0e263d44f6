//! Rules around another rule: remedies for inelastic collapse and matter at rest, and rolling friction.

use super::{CollisionRule, Contact, Elastic, Impulse, KnownRule, Regime};
use crate::quantity::{non_negative, positive};
use crate::{Fingerprint, ParameterError};

/// The choice of the tangential impulse in a contact that [`ContactDuration`] or [`ElasticBelow`] makes
/// elastic.
///
/// Published codes differ in this choice, so it is explicit here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum TangentialResponse {
    /// No tangential impulse: the contact is elastic and frictionless.
    #[default]
    Frictionless,
    /// The tangential impulse and the couple of the rule: only the normal direction becomes elastic. Friction
    /// then keeps cooling matter at rest, so runs still stall.
    Unchanged,
    /// The slip reverses without loss, as between perfectly rough surfaces. The slip is then zero on average,
    /// so surfaces at rest hold each other, however weak the friction of the rule is.
    Reversing,
}

impl TangentialResponse {
    /// Returns the impulse of an elastic contact, in place of the impulse of `rule`.
    pub(super) fn elastic<R: CollisionRule>(self, rule: &R, contact: &Contact, regime: Regime) -> Impulse {
        let normal = Elastic.impulse(contact).normal();
        let impulse = match self {
            Self::Frictionless => Impulse::new(normal, 0.0),
            Self::Unchanged => rule.impulse(contact).with_normal(normal),
            Self::Reversing => Impulse::new(normal, 2.0 * contact.tangential_mass() * contact.slip_speed()),
        };
        impulse.with_regime(regime)
    }
}

/// The contact-duration (TC) model added to any rule: a collision loses no energy if one of the bodies
/// collided less than t_c ago (Luding and McNamara 1998).
///
/// Without the model, disks in dense inelastic states collide infinitely often in finite time, and the run
/// ends with an error. The simulation counts the collisions that the model changes; their number shows
/// whether the model matters. With a collision rate $`\omega_c`$ per disk, the model removes a share of about
/// $`2.25\,\omega_c t_c`$ of the dissipation: measured, 2.2 in dense gases and 2.35 in the most dilute ones,
/// where the Boltzmann equation gives 2.37 for disks (and 2.25 for spheres: Luding and Goldshtein 2003).
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, ContactDuration, Frictional, Regime};
///
/// let rule = ContactDuration::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 1e-4)?;
/// let fresh = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let again = fresh.with_time_since_last_collision(1e-5);
/// assert!(rule.impulse(&fresh).energy_change(&fresh) < 0.0);
/// assert_eq!(rule.impulse(&again).energy_change(&again), 0.0);
/// assert_eq!(rule.impulse(&again).regime(), Regime::ContactDuration);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactDuration<R> {
    rule: R,
    duration: f64,
    tangential_response: TangentialResponse,
}

impl<R> ContactDuration<R> {
    /// Creates the model over `rule`: collisions of bodies that collided less than `duration` ago are elastic
    /// and frictionless.
    ///
    /// # Errors
    /// If the duration is not finite and positive. To have no contact duration, use the rule alone.
    pub fn new(rule: R, duration: f64) -> Result<Self, ParameterError> {
        positive("contact duration", duration)?;
        Ok(Self { rule, duration, tangential_response: TangentialResponse::default() })
    }

    /// Returns the same model with this tangential response.
    pub fn with_tangential_response(self, tangential_response: TangentialResponse) -> Self {
        Self { tangential_response, ..self }
    }

    /// Returns the inner rule, which decides all other collisions.
    pub const fn rule(&self) -> &R {
        &self.rule
    }

    /// Returns the contact duration t_c.
    pub const fn duration(&self) -> f64 {
        self.duration
    }
}

impl<R: CollisionRule> CollisionRule for ContactDuration<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        if contact.time_since_last_collision() < self.duration {
            self.tangential_response.elastic(&self.rule, contact, Regime::ContactDuration)
        } else {
            self.rule.impulse(contact)
        }
    }

    /// Returns `None` if the inner rule has no fingerprint: two such models could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        let rule = Fingerprint::of("ContactDuration").part(self.rule.fingerprint()?).number(self.duration);
        Some(rule.number(f64::from(self.tangential_response as u8)))
    }

    fn known(&self) -> Option<KnownRule> {
        let Self { duration, tangential_response, .. } = *self;
        Some(Box::new(ContactDuration { rule: self.rule.known()?, duration, tangential_response }).into())
    }
}

crate::gate::from_file! {
    ContactDuration<R> { rule: R, duration: f64, #[serde(default)] tangential_response: TangentialResponse } =>
        Ok(Self::new(rule, duration)?.with_tangential_response(tangential_response))
}

/// A rule whose slow collisions are elastic: surfaces part at least at the speed v_c or, if they closed more
/// slowly, as fast as they closed.
///
/// ```math
/// v_n' = \max\left(r_n v_n,\ \min(v_n, v_c)\right)
/// ```
///
/// A disk that comes to rest on a floor then bounces at the speed $`v_c`$, once every $`2v_c/g`$. Many disks
/// share the energy that the last fast collisions left them. If the tangential response loses nothing, their
/// granular temperature stays constant. This temperature may be far below $`m v_c^2`$, and the lower it is,
/// the more often disks collide. [`LeastRebound`] bounds the number of collisions. The
/// page `docs/rest.md` of the repository compares the remedies.
///
/// Collisions with $`v_c \le v_n < v_c/r_n`$ lose less, too, but keep the regime of the inner rule. In a gas
/// of temperature $`T`$, with a constant $`r_n`$ and $`x = m v_c^2/4T`$, the remedy removes this share of the
/// normal dissipation:
///
/// ```math
/// 1 - \frac{e^{-x} - r_n^2\,e^{-x/r_n^2}}{1 - r_n^2} \approx \frac{x^2}{2\,r_n^2}
/// ```
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, ElasticBelow, Frictional, Regime};
///
/// let rule = ElasticBelow::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 0.05)?;
/// let fast = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let slow = Contact::new(0.01, 0.5, 0.5, 1.0 / 6.0);
/// assert!(rule.impulse(&fast).energy_change(&fast) < 0.0);
/// assert_eq!(rule.impulse(&slow).energy_change(&slow), 0.0);
/// assert_eq!(rule.impulse(&slow).regime(), Regime::ElasticBelow);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ElasticBelow<R> {
    rule: R,
    speed: f64,
    tangential_response: TangentialResponse,
}

impl<R> ElasticBelow<R> {
    /// Creates the remedy over `rule`: collisions below this closing speed are elastic and frictionless.
    ///
    /// # Errors
    /// If the speed is not finite and positive. For no limit, use the rule without this remedy.
    pub fn new(rule: R, speed: f64) -> Result<Self, ParameterError> {
        positive("speed of elastic collisions", speed)?;
        Ok(Self { rule, speed, tangential_response: TangentialResponse::default() })
    }

    /// Returns the same remedy with this tangential response.
    pub fn with_tangential_response(self, tangential_response: TangentialResponse) -> Self {
        Self { tangential_response, ..self }
    }
}

impl<R: CollisionRule> CollisionRule for ElasticBelow<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        if contact.closing_speed() < self.speed {
            return self.tangential_response.elastic(&self.rule, contact, Regime::ElasticBelow);
        }
        self.rule.impulse(contact).parting_at_least(self.speed, contact)
    }

    /// Returns `None` if the inner rule has no fingerprint: two such remedies could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        let rule = Fingerprint::of("ElasticBelow").part(self.rule.fingerprint()?).number(self.speed);
        Some(rule.number(f64::from(self.tangential_response as u8)))
    }

    fn known(&self) -> Option<KnownRule> {
        let Self { speed, tangential_response, .. } = *self;
        Some(Box::new(ElasticBelow { rule: self.rule.known()?, speed, tangential_response }).into())
    }
}

crate::gate::from_file! {
    ElasticBelow<R> { rule: R, speed: f64, #[serde(default)] tangential_response: TangentialResponse } =>
        Ok(Self::new(rule, speed)?.with_tangential_response(tangential_response))
}

/// A rule with a least parting speed: after each collision, the surfaces part at v_c or faster.
///
/// ```math
/// v_n' = \max\left(r_n v_n,\ v_c\right)
/// ```
///
/// A grain at rest then bounces at $`v_c`$, as if the ground trembled. Each collision transfers at least the
/// momentum $`\mu v_c`$, so a contact that carries the mean force $`F`$ has at most $`F/\mu v_c`$ collisions
/// per unit of time, however much the rule loses. The cost of matter at rest is therefore known beforehand,
/// and friction stays unchanged.
///
/// **The rule gains energy** where surfaces close more slowly than they part, at most
/// $`\tfrac12\mu(v_c^2 - v_n^2)`$. Friction and faster collisions take this energy away. Matter at rest keeps
/// a granular temperature of the order of $`m v_c^2`$ and creeps because of it. Without gravity, a gas that
/// should cool forever stops cooling. The page `docs/rest.md` of the repository compares this remedy with
/// others.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Frictional, LeastRebound, laws};
///
/// let frictional = Frictional::from_inelasticity(0.1, 0.1, 0.3)?;
/// let rule = LeastRebound::new(frictional, 0.01)?;
/// let fast = Contact::new(1.0, 0.5, 0.5, 1.0 / 6.0);
/// let slow = Contact::new(0.001, 0.0, 0.5, 1.0 / 6.0);
/// assert_eq!(rule.impulse(&fast), frictional.impulse(&fast));
/// assert!((rule.impulse(&slow).closing_speed_after(&slow) + 0.01).abs() < 1e-15);
/// laws::check(&rule, &laws::Promises::new().with_friction(0.3).with_energy_gain())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeastRebound<R> {
    rule: R,
    speed: f64,
}

impl<R> LeastRebound<R> {
    /// Creates the remedy over `rule`, with this least parting speed.
    ///
    /// # Errors
    /// If the speed is not finite and positive. To have no least speed, use the rule alone.
    pub fn new(rule: R, speed: f64) -> Result<Self, ParameterError> {
        Ok(Self { rule, speed: positive("least speed of rebound", speed)? })
    }
}

impl<R: CollisionRule> CollisionRule for LeastRebound<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let impulse = self.rule.impulse(contact);
        let raised = impulse.parting_at_least(self.speed, contact);
        if raised.normal() > impulse.normal() { raised.with_regime(Regime::LeastRebound) } else { raised }
    }

    /// Returns `None` if the inner rule has no fingerprint: two such remedies could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("LeastRebound").part(self.rule.fingerprint()?).number(self.speed))
    }

    fn known(&self) -> Option<KnownRule> {
        Some(Box::new(LeastRebound { rule: self.rule.known()?, speed: self.speed }).into())
    }
}

crate::gate::from_file! {
    LeastRebound<R> { rule: R, speed: f64 } => Self::new(rule, speed)
}

/// Rolling friction added to any rule: a couple slows the relative spin of the partners, up to a limit that
/// grows with the normal impulse.
///
/// With the relative spin $`\omega'`$ that the inner rule leaves, and the effective radius
/// $`R = R_1R_2/(R_1 + R_2)`$,
///
/// ```math
/// C = \min\left(\mu_r\,\Delta_n R,\ I\,|\omega'|\right)\,\mathrm{sign}\,\omega'
/// ```
///
/// This is Coulomb's law of rolling resistance with impulses in place of forces: a lasting contact resists
/// rolling by a torque of at most $`\mu_r F_n R`$ (Iwashita and Oda 1998, without their spring). The couple
/// transfers no momentum, so it does not act on disks that only translate. A straight wall, or the corner or
/// end of a part, has $`R_2 = \infty`$.
///
/// The couple acts after the tangential impulse, on the spins that friction has left. Friction is thus the
/// same with and without rolling friction, and the couple never gains energy, whatever the inner rule does:
/// the couple removes the energy $`C(|\omega'| - C/2I)`$. In the other order, it could push surfaces that
/// have just stuck.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Elastic, RollingFriction};
///
/// let rule = RollingFriction::new(Elastic, 0.25)?;
/// // Two disks head on: normal impulse 2, effective radius 1/4.
/// let turning = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0).with_spin(4.0, 0.0625, 0.0);
/// assert_eq!(rule.impulse(&turning).couple(), 0.125);
/// assert_eq!(rule.impulse(&turning).relative_spin_after(&turning), 2.0);
/// // The same couple would reverse a slow spin, so a smaller couple stops it.
/// let slow = turning.with_spin(1.0, 0.0625, 0.0);
/// assert_eq!(rule.impulse(&slow).relative_spin_after(&slow), 0.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RollingFriction<R> {
    rule: R,
    coefficient: f64,
}

impl<R> RollingFriction<R> {
    /// Creates a rule that adds rolling friction with the coefficient μ_r to `rule`.
    ///
    /// # Errors
    /// If the coefficient is not finite, or negative.
    pub fn new(rule: R, coefficient: f64) -> Result<Self, ParameterError> {
        Ok(Self { rule, coefficient: non_negative("coefficient of rolling friction", coefficient)? })
    }
}

impl<R: CollisionRule> CollisionRule for RollingFriction<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let impulse = self.rule.impulse(contact);
        let stopping = contact.spin_inertia() * impulse.relative_spin_after(contact);
        let limit = self.coefficient * impulse.normal() * contact.effective_radius();
        // For a rule that pulls the surfaces together, the limit is negative; such a rule gets no couple.
        let couple = if stopping.abs() <= limit { stopping } else { limit.max(0.0).copysign(stopping) };
        impulse.with_couple(impulse.couple() + couple)
    }

    /// Returns `None` if the inner rule has no fingerprint: two such rules could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("RollingFriction").part(self.rule.fingerprint()?).number(self.coefficient))
    }

    fn known(&self) -> Option<KnownRule> {
        let rule = self.rule.known()?;
        Some(Box::new(RollingFriction { rule, coefficient: self.coefficient }).into())
    }
}

crate::gate::from_file! {
    RollingFriction<R> { rule: R, coefficient: f64 } => Self::new(rule, coefficient)
}
