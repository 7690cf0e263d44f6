//! Contacts, in the form that rules receive, and impulses, the results of rules.

use std::fmt;

use crate::Kind;

/// A contact of two surfaces: their closing and slip speeds, the masses that resist, and the kinds and radii
/// of the partners.
///
/// With $`\hat n`$ from partner 2 to partner 1 and $`\vec v = \vec v_{C2} - \vec v_{C1}`$ the relative
/// velocity of the points in contact, the closing speed is $`v_n = \vec v\cdot\hat n`$ and the slip speed
/// $`v_t = \vec v\cdot\hat t`$. An impulse $`\Delta_n`$ changes $`v_n`$ by $`-\Delta_n/\mu`$, and
/// $`\Delta_t`$ changes $`v_t`$ by $`-\Delta_t/\mu_t`$, where $`1/\mu = \sum 1/m_i`$ and
/// $`1/\mu_t = \sum (1 + 1/\beta_i)/m_i`$ (for homogeneous disks $`\mu_t = \mu/3`$).
///
/// The relative spin is $`\omega = \omega_1 - \omega_2`$, counterclockwise. A couple $`C`$ changes it by
/// $`-C/I`$, where $`1/I = \sum 1/I_i`$, and the slip speed by $`-kC`$, where
/// $`k = R_1/I_1 - R_2/I_2`$; a tangential impulse changes the relative spin by $`-k\Delta_t`$.
///
/// # Order of the partners
/// In a collision with a wall, partner 2 is the wall. In a collision of two disks, either may be partner 1,
/// so a rule must give the same physics for the partners in either order, and for the mirror image of the
/// contact: [`laws::check`](super::laws::check) tests both.
///
/// A wall is a partner of infinite mass, unless it reacts. A straight wall has an infinite radius, a hollow
/// one a negative radius.
///
/// ```
/// use granular_edmd::collision::Contact;
/// let contact = Contact::new(1.5, -0.25, 0.5, 0.5 / 3.0);
/// assert_eq!(contact.closing_speed(), 1.5);
/// assert_eq!(contact.time_since_last_collision(), f64::INFINITY);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    closing_speed: f64,
    slip_speed: f64,
    normal_mass: f64,
    tangential_mass: f64,
    time_since_last_collision: f64,
    kinds: [Kind; 2],
    radii: [f64; 2],
    relative_spin: f64,
    spin_inertia: f64,
    spin_response: f64,
}

impl Contact {
    /// Creates a contact of two homogeneous disks of radius 1/2, of the default kind and of equal spins, that
    /// have never collided before.
    pub const fn new(closing_speed: f64, slip_speed: f64, normal_mass: f64, tangential_mass: f64) -> Self {
        Self {
            closing_speed,
            slip_speed,
            normal_mass,
            tangential_mass,
            time_since_last_collision: f64::INFINITY,
            kinds: [Kind::DEFAULT; 2],
            radii: [0.5; 2],
            relative_spin: 0.0,
            spin_inertia: 0.125 * normal_mass,
            spin_response: 0.0,
        }
    }

    /// Returns the same contact, at this time after the latest collision of either partner.
    pub const fn with_time_since_last_collision(self, time: f64) -> Self {
        Self { time_since_last_collision: time, ..self }
    }

    /// Returns the same contact between partners of these kinds.
    pub const fn with_kinds(self, kinds: [Kind; 2]) -> Self {
        Self { kinds, ..self }
    }

    /// Returns the same contact between partners of these radii; infinite for a straight wall, negative for a
    /// hollow one.
    pub const fn with_radii(self, radii: [f64; 2]) -> Self {
        Self { radii, ..self }
    }

    /// Returns the same contact with this relative spin ω, the moment of inertia I that resists a couple, and
    /// the response k of the spin to a tangential impulse.
    pub const fn with_spin(self, relative_spin: f64, spin_inertia: f64, spin_response: f64) -> Self {
        Self { relative_spin, spin_inertia, spin_response, ..self }
    }

    /// Returns the speed v_n at which the surfaces approach; it is never negative in a collision.
    pub const fn closing_speed(&self) -> f64 {
        self.closing_speed
    }

    /// Returns the speed v_t at which the surfaces slide, of either sign.
    pub const fn slip_speed(&self) -> f64 {
        self.slip_speed
    }

    /// Returns the reduced mass μ for the normal direction.
    pub const fn normal_mass(&self) -> f64 {
        self.normal_mass
    }

    /// Returns the effective mass μ_t for the tangential direction, which includes rotation.
    pub const fn tangential_mass(&self) -> f64 {
        self.tangential_mass
    }

    /// Returns the time since either partner last collided with anything, or infinity if neither has
    /// collided.
    pub const fn time_since_last_collision(&self) -> f64 {
        self.time_since_last_collision
    }

    /// Returns the kinds of both partners.
    pub const fn kinds(&self) -> [Kind; 2] {
        self.kinds
    }

    /// Returns whether one partner is of the first kind and the other of the second.
    #[inline]
    pub fn is_between(&self, first: Kind, second: Kind) -> bool {
        self.kinds == [first, second] || self.kinds == [second, first]
    }

    /// Returns the radii of both partners: infinite for a straight wall, negative for a hollow one.
    pub const fn radii(&self) -> [f64; 2] {
        self.radii
    }

    /// Returns the relative spin ω = ω₁ − ω₂. A wall has the spin of its part, which is 0 unless the part
    /// turns.
    pub const fn relative_spin(&self) -> f64 {
        self.relative_spin
    }

    /// Returns the moment of inertia I that resists a couple, 1/I = 1/I₁ + 1/I₂.
    pub const fn spin_inertia(&self) -> f64 {
        self.spin_inertia
    }

    /// Returns the response k = R₁/I₁ − R₂/I₂ of the relative spin to a tangential impulse, and of the slip
    /// speed to a couple; zero for equal disks.
    pub const fn spin_response(&self) -> f64 {
        self.spin_response
    }

    /// Returns the effective radius, R₁R₂/(R₁ + R₂).
    ///
    /// At a straight wall, it is the radius of the disk; at a concave wall, it is larger. The laws of Hertz
    /// for elastic and viscoelastic grains need it.
    ///
    /// ```
    /// use granular_edmd::collision::Contact;
    /// let contact = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0);
    /// assert_eq!(contact.effective_radius(), 0.25);
    /// assert_eq!(contact.with_radii([0.5, f64::INFINITY]).effective_radius(), 0.5);
    /// assert_eq!(contact.with_radii([0.5, -1.0]).effective_radius(), 1.0);
    /// ```
    pub const fn effective_radius(&self) -> f64 {
        let [first, second] = self.radii;
        // This form gives the same number for either order of the partners, and the limit for a straight
        // wall.
        if first.abs() < second.abs() {
            first / (1.0 + first / second)
        } else {
            second / (1.0 + second / first)
        }
    }

    /// Returns the kinetic energy of the relative motion of the surfaces, ½μ v_n² + ½μ_t v_t².
    ///
    /// A collision without a couple can lose no more than this energy.
    pub const fn available_energy(&self) -> f64 {
        let (closing, slip) = (self.closing_speed, self.slip_speed);
        0.5 * self.normal_mass * (closing * closing) + 0.5 * self.tangential_mass * (slip * slip)
    }

    /// Returns the normal impulse for a restitution coefficient (paper, Eqs. (1), (3)).
    ///
    /// The impulse is $`\Delta_n = (1 + r_n)\,\mu\,v_n`$. The function does not check the restitution,
    /// because rules that compute it from the contact call it in every collision.
    ///
    /// ```
    /// use granular_edmd::collision::Contact;
    /// let contact = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0);
    /// assert_eq!(contact.normal_impulse(0.5), 1.5);
    /// ```
    pub const fn normal_impulse(&self, restitution: f64) -> f64 {
        (1.0 + restitution) * self.normal_mass * self.closing_speed
    }
}

impl fmt::Display for Contact {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { closing_speed, slip_speed, normal_mass, tangential_mass, .. } = self;
        let (since, [first, second], [one, other]) = (self.time_since_last_collision, self.radii, self.kinds);
        write!(
            formatter,
            "closing speed {closing_speed:?}, slip speed {slip_speed:?}, normal mass {normal_mass:?}, \
             tangential mass {tangential_mass:?}, time since the last collision {since:?}, \
             radii {first:?} and {second:?}, kinds {one} and {other}"
        )?;
        let (spin, inertia, response) = (self.relative_spin, self.spin_inertia, self.spin_response);
        if spin == 0.0 && response == 0.0 {
            return Ok(());
        }
        write!(
            formatter,
            ", relative spin {spin:?} with the inertia {inertia:?} and the response {response:?}"
        )
    }
}

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
    pub const fn new(normal: f64, tangential: f64) -> Self {
        Self { normal, tangential, couple: 0.0, regime: Regime::Unspecified }
    }

    /// Returns the same impulse with a couple, an angular impulse that acts against the relative spin if both
    /// have the same sign.
    ///
    /// Partner 1 loses this angular momentum about its center, and partner 2 receives it, so the total is
    /// conserved. A couple models rolling friction, which needs a contact of finite width.
    pub const fn with_couple(self, couple: f64) -> Self {
        Self { couple, ..self }
    }

    /// Returns the same impulse with this label.
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
    pub const fn normal(&self) -> f64 {
        self.normal
    }

    /// Returns the tangential part Δ_t, which has the sign of the slip speed if it slows the slip.
    pub const fn tangential(&self) -> f64 {
        self.tangential
    }

    /// Returns the couple C, which has the sign of the relative spin if it slows the rolling.
    pub const fn couple(&self) -> f64 {
        self.couple
    }

    /// Returns the regime of the collision.
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
