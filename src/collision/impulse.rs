//! Impulses: the results of collision rules.

use std::fmt;

use super::Contact;

/// The regime of a collision, for statistics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Regime {
    /// The rule does not report a regime.
    #[default]
    Unspecified,
    /// The surfaces held: the tangential impulse stayed below the limit of static friction.
    Sticking,
    /// The surfaces slid: dynamic friction sets the tangential impulse.
    Sliding,
    /// A contact-duration model replaced the rule.
    ContactDuration,
    /// The contact was so slow that a remedy made it elastic.
    ElasticBelow,
    /// The surfaces would have parted too slowly, so a remedy raised the speed.
    LeastRebound,
}

/// The momentum that partner 1 receives along the normal and the tangent, and a couple.
///
/// Partner 2 receives the opposite.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0);
/// let stop = Impulse::new(0.5, 0.0);
/// assert_eq!(stop.energy_change(&contact), -0.25);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse {
    normal: f64,
    tangential: f64,
    couple: f64,
    regime: Regime,
}

impl Impulse {
    /// Creates an impulse from its normal and its tangential part.
    #[inline]
    pub const fn new(normal: f64, tangential: f64) -> Self {
        Self { normal, tangential, couple: 0.0, regime: Regime::Unspecified }
    }

    /// Returns the same impulse with a couple, an angular impulse that acts against the relative spin if both
    /// have the same sign.
    ///
    /// Partner 1 loses this angular momentum about its center, and partner 2 receives it, so the total is
    /// conserved. A couple models rolling friction, which needs a contact of finite width.
    #[inline]
    pub const fn with_couple(self, couple: f64) -> Self {
        Self { couple, ..self }
    }

    /// Returns the same impulse with this label.
    #[inline]
    pub const fn with_regime(self, regime: Regime) -> Self {
        Self { regime, ..self }
    }

    /// Returns the same impulse with another normal part.
    pub(crate) const fn with_normal(self, normal: f64) -> Self {
        Self { normal, ..self }
    }

    /// Returns the same impulse, with a normal part large enough that the surfaces part at this speed or
    /// faster.
    #[inline]
    pub(super) fn parting_at_least(self, speed: f64, contact: &Contact) -> Self {
        let least = contact.normal_mass() * (contact.closing_speed() + speed);
        // The comparison is false for an impulse that is not a number, so the engine sees such an impulse and
        // reports it.
        if self.normal < least { Self { normal: least, ..self } } else { self }
    }

    /// Returns the normal part Δ_n, positive if it pushes the partners apart.
    #[inline]
    pub const fn normal(&self) -> f64 {
        self.normal
    }

    /// Returns the tangential part Δ_t, which has the sign of the slip speed if it slows the slip.
    #[inline]
    pub const fn tangential(&self) -> f64 {
        self.tangential
    }

    /// Returns the couple C, which has the sign of the relative spin if it slows the rolling.
    #[inline]
    pub const fn couple(&self) -> f64 {
        self.couple
    }

    /// Returns the regime of the collision.
    #[inline]
    pub const fn regime(&self) -> Regime {
        self.regime
    }

    /// Returns the closing speed after the collision, v_n′ = v_n − Δ_n/μ; negative if the surfaces separate.
    #[inline]
    pub fn closing_speed_after(&self, contact: &Contact) -> f64 {
        contact.closing_speed() - self.normal / contact.normal_mass()
    }

    /// Returns the slip speed after the collision, v_t′ = v_t − Δ_t/μ_t − kC.
    #[inline]
    pub fn slip_speed_after(&self, contact: &Contact) -> f64 {
        let slip = contact.slip_speed() - self.tangential / contact.tangential_mass();
        if self.couple == 0.0 { slip } else { slip - contact.spin_response() * self.couple }
    }

    /// Returns the relative spin after the collision, ω′ = ω − kΔ_t − C/I.
    #[inline]
    pub fn relative_spin_after(&self, contact: &Contact) -> f64 {
        let rolling = contact.relative_spin() - contact.spin_response() * self.tangential;
        rolling - self.couple / contact.spin_inertia()
    }

    /// Returns the change of kinetic energy in the collision, as seen from the wall if one partner is a wall:
    ///
    /// ```math
    /// dE = -\Delta_n\left(v_n - \frac{\Delta_n}{2\mu}\right)
    /// - \Delta_t\left(v_t - \frac{\Delta_t}{2\mu_t}\right)
    /// - C\left(\omega - k\Delta_t - \frac{C}{2I}\right)
    /// ```
    ///
    /// For two disks the change does not depend on the frame. With Eqs. (3)–(5) for equal homogeneous disks,
    /// it is the paper's Eq. (7) if they slide, and Eq. (6) if they stick, with the factor 1/3 that is
    /// missing in print.
    #[inline]
    pub fn energy_change(&self, contact: &Contact) -> f64 {
        let normal = self.normal * (contact.closing_speed() - 0.5 * self.normal / contact.normal_mass());
        let tangential =
            self.tangential * (contact.slip_speed() - 0.5 * self.tangential / contact.tangential_mass());
        // The comparison costs nothing for a rule that never gives a couple, since the compiler then knows
        // its result.
        if self.couple == 0.0 {
            return -(normal + tangential);
        }
        let rolling = contact.relative_spin() - contact.spin_response() * self.tangential;
        -(normal + tangential + self.couple * (rolling - 0.5 * self.couple / contact.spin_inertia()))
    }
}

impl fmt::Display for Impulse {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "({:?}, {:?})", self.normal, self.tangential)?;
        if self.couple == 0.0 { Ok(()) } else { write!(formatter, " with a couple of {:?}", self.couple) }
    }
}
