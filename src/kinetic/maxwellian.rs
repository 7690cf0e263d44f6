//! The Maxwellian gas whose collisions are averaged, with the mean energy change as a formula.

use crate::collision::{Contact, Frictional, Smooth};
use crate::disk::{SCALE, scale};
use crate::quantity::{accept, positive};
use crate::{Disk, Kind, ParameterError};

/// The sine and cosine of the half angle α of the sticking sector.
///
/// In the scaled speeds $`x = v_n/\sqrt S`$, $`z = v_t/\sqrt V`$, a collision sticks for
/// $`|z| < x\tan\alpha`$. The vector (x cos φ, x sin φ, z) is isotropic, so $`\sin\alpha`$ is the probability
/// of sticking.
///
/// Formulas use $`s = \sin\alpha`$ and $`k = \cos\alpha`$ side by side. At large friction $`s`$ rounds to 1
/// and $`1 - s`$ would have no digits left; $`k^2/(1 + s)`$ is the same number with all its digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StickSlip {
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

impl StickSlip {
    /// Creates the sector with tan α = κ·(opposite/adjacent). If `adjacent` is zero and κ is not, all
    /// collisions stick.
    #[inline]
    pub(super) fn new(friction: f64, opposite: f64, adjacent: f64) -> Self {
        if friction == 0.0 {
            return Self { sine: 0.0, cosine: 1.0 };
        }
        // Only the ratio of the sides matters. Friction above 1 divides one side instead of multiplying the
        // other, so that neither side overflows at any friction.
        let (opposite, adjacent) =
            if friction > 1.0 { (opposite, adjacent / friction) } else { (opposite * friction, adjacent) };
        let hypotenuse = libm::hypot(opposite, adjacent);
        Self { sine: opposite / hypotenuse, cosine: adjacent / hypotenuse }
    }

    /// Returns ⟨v_t²; stick⟩/V = s³.
    #[inline]
    pub(super) fn sticking_slip(self) -> f64 {
        self.sine * self.sine * self.sine
    }

    /// Returns ⟨v_n²; slide⟩/(S k²) = (1 − s)²(2 + s)/k² = k²(2 + s)/(1 + s)².
    #[inline]
    pub(super) fn sliding_closing(self) -> f64 {
        let above = 1.0 + self.sine;
        self.cosine * self.cosine * (2.0 + self.sine) / (above * above)
    }
}

/// A gas of disks with Maxwellian velocities and spins, described by the collisions of two of its disks.
///
/// Velocities have the translational temperature, $`T = m\langle v_x^2\rangle`$, and spins have the
/// rotational temperature, $`T_r = I\langle\omega^2\rangle`$ (Boltzmann's constant is 1: temperatures are
/// energies). Over the collisions of the gas, the closing speed has the flux-weighted density
/// $`(v_n/S)\,e^{-v_n^2/2S}`$, and the slip speed is an independent normal variable of variance $`V`$, with
///
/// ```math
/// S = \frac{T}{\mu},\qquad V = \frac{T}{\mu} + T_r\left(\frac1{\mu_t}-\frac1\mu\right),
/// ```
///
/// since $`1/\mu_t - 1/\mu = R_1^2/I_1 + R_2^2/I_2`$, where the radii drop out. The derivation is in
/// `docs/physics-kinetic.md`.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::kinetic::Maxwellian;
///
/// // The paper's gas: identical homogeneous disks of mass 1, all temperatures 1.
/// let gas = Maxwellian::new(1.0)?;
/// assert_eq!((gas.closing_variance(), gas.slip_variance()), (2.0, 6.0));
///
/// // Spins at a tenth of the temperature, and a disk that meets a ring four times as heavy.
/// let disk = Disk::new(DVec2::ZERO, 0.5)?;
/// let ring = disk.with_mass(4.0)?.with_inertia_factor(1.0)?;
/// let gas = Maxwellian::new(1.0)?.with_rotational_temperature(0.1)?.with_partners(&disk, &ring);
/// assert!((gas.slip_variance() - (1.25 + 0.1 * (2.0 + 0.25))).abs() < 1e-15);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maxwellian {
    translational_temperature: f64,
    rotational_temperature: f64,
    masses: [f64; 2],
    inertia_factors: [f64; 2],
    radii: [f64; 2],
    kinds: [Kind; 2],
}

impl Maxwellian {
    /// Creates a gas of identical homogeneous disks of mass 1, radius 1/2 and the default kind, with
    /// velocities and spins at this temperature.
    ///
    /// # Errors
    /// If the temperature is not in `[1e-30, 1e30]`.
    pub fn new(temperature: f64) -> Result<Self, ParameterError> {
        scale("translational temperature", temperature)?;
        Ok(Self {
            translational_temperature: temperature,
            rotational_temperature: temperature,
            masses: [1.0; 2],
            inertia_factors: [Disk::HOMOGENEOUS_INERTIA_FACTOR; 2],
            radii: [0.5; 2],
            kinds: [Kind::DEFAULT; 2],
        })
    }

    /// Returns the same gas with its spins at another temperature.
    ///
    /// At temperature zero, no disk rotates before it collides.
    ///
    /// # Errors
    /// If the temperature is not in `[0, 1e30]`.
    pub fn with_rotational_temperature(self, temperature: f64) -> Result<Self, ParameterError> {
        let valid = (0.0..=*SCALE.end()).contains(&temperature);
        accept(valid, "rotational temperature", "in [0, 1e30]", temperature)?;
        Ok(Self { rotational_temperature: temperature, ..self })
    }

    /// Returns the same gas, with collisions between these two kinds of disks.
    ///
    /// Their masses, inertia factors, radii and kinds matter; positions and motions are ignored.
    pub fn with_partners(self, first: &Disk, second: &Disk) -> Self {
        let partners = [first, second];
        Self {
            masses: partners.map(Disk::mass),
            inertia_factors: partners.map(Disk::inertia_factor),
            radii: partners.map(Disk::radius),
            kinds: partners.map(Disk::kind),
            ..self
        }
    }

    /// Returns the translational temperature, T = m⟨v_x²⟩.
    pub const fn translational_temperature(&self) -> f64 {
        self.translational_temperature
    }

    /// Returns the rotational temperature, T_r = I⟨ω²⟩.
    pub const fn rotational_temperature(&self) -> f64 {
        self.rotational_temperature
    }

    /// Returns the normal effective mass μ, with 1/μ = Σ 1/mᵢ.
    pub fn normal_mass(&self) -> f64 {
        1.0 / (1.0 / self.masses[0] + 1.0 / self.masses[1])
    }

    /// Returns the tangential effective mass μ_t, with 1/μ_t = Σ (1 + 1/βᵢ)/mᵢ.
    pub fn tangential_mass(&self) -> f64 {
        1.0 / (self.compliance(0) + self.compliance(1))
    }

    /// Returns half the mean square of the closing speed over collisions, S.
    pub fn closing_variance(&self) -> f64 {
        self.translational_temperature / self.normal_mass()
    }

    /// Returns the mean square of the slip speed over collisions, V.
    pub fn slip_variance(&self) -> f64 {
        self.closing_variance() * self.slip_ratio_squared()
    }

    fn compliance(&self, partner: usize) -> f64 {
        (1.0 + 1.0 / self.inertia_factors[partner]) / self.masses[partner]
    }

    /// Returns the ratio of the effective masses, λ = μ/μ_t. It is 3 for homogeneous disks of any masses.
    #[inline]
    pub(super) fn mass_ratio(&self) -> f64 {
        self.normal_mass() / self.tangential_mass()
    }

    /// Returns the ratio of the variances, w² = V/S = 1 + (λ − 1) T_r/T.
    #[inline]
    pub(super) fn slip_ratio_squared(&self) -> f64 {
        1.0 + (self.mass_ratio() - 1.0) * (self.rotational_temperature / self.translational_temperature)
    }

    /// Returns the contact with these speeds, given in units of √S and √V. The third number is the part of
    /// the relative spin that is independent of the slip, in units of its standard deviation.
    ///
    /// Slip and relative spin are the sum and the difference of the same two spins, so they are correlated:
    /// ⟨v_t ω⟩ = k T_r, and ⟨ω²⟩ = T_r/I.
    #[inline]
    pub(super) fn contact(&self, closing: f64, slip: f64, spin: f64) -> Contact {
        let (variance, temperature) = (self.slip_variance(), self.rotational_temperature);
        let [first, second] =
            [0, 1].map(|disk| 1.0 / (self.inertia_factors[disk] * self.masses[disk] * self.radii[disk]));
        let (response, mobility) = (first - second, first / self.radii[0] + second / self.radii[1]);
        let slip = slip * variance.sqrt();
        // With this bound, the independent part is never negative by rounding.
        let independent = (mobility - response * response * temperature / variance).max(0.0);
        let spin = response * temperature / variance * slip + (temperature * independent).sqrt() * spin;
        let closing = closing * self.closing_variance().sqrt();
        Contact::new(closing, slip, self.normal_mass(), self.tangential_mass())
            .with_kinds(self.kinds)
            .with_radii(self.radii)
            .with_spin(spin, 1.0 / mobility, response)
    }
}

/// Returns the exact mean energy change per collision of the paper's rule in a Maxwellian gas.
///
/// ```math
/// \frac{\langle dE\rangle}{T} = -4q_n p - \frac2\lambda\,q_t(1-q_t)\,w^2 s^3 - 2\kappa_d p\,w\,k^3
/// + 2\kappa_d^2p^2\lambda\,(1-s)^2(2+s)
/// ```
///
/// with $`p = 1-q_n`$, $`\lambda = \mu/\mu_t`$, $`w^2 = 1+(\lambda-1)T_r/T`$, and the sticking probability
/// $`s = \sin\alpha`$, $`k = \cos\alpha`$, $`\tan\alpha = \lambda p\kappa_s/\big((1-q_t)w\big)`$. The result
/// is an energy, in the units of the temperature. The paper computes this average by Monte Carlo only (Fig.
/// 1). At zero friction the average is the paper's Eq. (8). The derivation is in `docs/physics-kinetic.md`.
///
/// Masses enter through $`\lambda`$ alone, which is 3 for homogeneous disks of any masses. Therefore, Fig. 1
/// of the paper holds for any mixture at equal temperatures.
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, mean_energy_change};
/// let gas = Maxwellian::new(1.0)?;
/// let rule = Frictional::from_inelasticity(0.0, 0.0, 0.3)?;
/// assert!((mean_energy_change(&rule, &gas) + 0.34014).abs() < 1e-5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[inline]
pub fn mean_energy_change(rule: &Frictional, gas: &Maxwellian) -> f64 {
    let (mass_ratio, slip_ratio_squared) = (gas.mass_ratio(), gas.slip_ratio_squared());
    let (normal, tangential) = (rule.normal_inelasticity(), rule.tangential_inelasticity());
    let sector = sector(rule, gas);
    // Friction can grow without bound, and the cosine of the sector then falls as the inverse of the
    // friction. Only their product stays finite.
    let friction = rule.dynamic_friction() * sector.cosine * (1.0 - normal);
    let sticking = tangential * (1.0 - tangential) * slip_ratio_squared / mass_ratio * sector.sticking_slip();
    let sliding = friction
        * (slip_ratio_squared.sqrt() * sector.cosine * sector.cosine
            - friction * mass_ratio * sector.sliding_closing());
    -gas.translational_temperature() * (4.0 * normal * (1.0 - normal) + 2.0 * (sticking + sliding))
}

/// Returns the fraction of collisions that stick, under the paper's rule in a Maxwellian gas.
///
/// The fraction is $`s = \sin\alpha`$ with $`\tan\alpha = \lambda(1-q_n)\kappa_s/\big((1-q_t)w\big)`$ (see
/// [`mean_energy_change`]).
///
/// ```
/// use granular_edmd::collision::Frictional;
/// use granular_edmd::kinetic::{Maxwellian, sticking_fraction};
/// let rule = Frictional::from_inelasticity(0.05, 0.05, 0.3)?;
/// let fraction = sticking_fraction(&rule, &Maxwellian::new(1.0)?);
/// assert!((fraction - 0.4611).abs() < 1e-4);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn sticking_fraction(rule: &Frictional, gas: &Maxwellian) -> f64 {
    sector(rule, gas).sine
}

#[inline]
fn sector(rule: &Frictional, gas: &Maxwellian) -> StickSlip {
    let opposite = gas.mass_ratio() * (1.0 - rule.normal_inelasticity());
    let adjacent = (1.0 - rule.tangential_inelasticity()) * gas.slip_ratio_squared().sqrt();
    StickSlip::new(rule.static_friction(), opposite, adjacent)
}

/// Returns the effective normal inelasticity: the inelasticity of smooth disks that lose the same energy per
/// collision.
///
/// The effective inelasticity is the paper's Eq. (9),
///
/// ```math
/// q_\text{eff} = \tfrac12\left(1 - \sqrt{1 + \langle dE\rangle/T}\right),
/// ```
///
/// in `[0, 1/2]`, for a mean energy change in $`[-T, 0]`$, with $`T`$ the translational temperature. No gas
/// of smooth disks is outside that range: with restitution zero they lose exactly $`T`$, and they never gain
/// energy. Disks with friction can lose more, and a Monte Carlo mean can exceed zero within its error. The
/// function refuses such values instead of clipping them.
///
/// # Errors
/// If the temperature is not positive, or the mean energy change is not in $`[-T, 0]`$.
///
/// ```
/// use granular_edmd::kinetic::effective_inelasticity;
/// assert!((effective_inelasticity(-0.290, 1.0)? - 0.079).abs() < 5e-4); // paper, Table I
/// let error = effective_inelasticity(-1.02, 1.0).unwrap_err();
/// assert_eq!(error.to_string(), "mean energy change per temperature must be in [-1, 0], but is -1.02");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn effective_inelasticity(mean_energy_change: f64, temperature: f64) -> Result<f64, ParameterError> {
    let change = mean_energy_change / positive("temperature", temperature)?;
    accept((-1.0..=0.0).contains(&change), "mean energy change per temperature", "in [-1, 0]", change)?;
    // This is (1 - root)/2, with numerator and denominator multiplied by (1 + root). At small losses the root
    // is close to 1, and the difference would keep few digits.
    Ok(0.5 * change.abs() / (1.0 + (1.0 + change).sqrt()))
}

/// Returns the mean energy change per collision without friction, the inverse of [`effective_inelasticity`].
///
/// The energy change is $`\langle dE\rangle = -4q_n(1-q_n)T`$ (paper, Eq. (8)).
///
/// # Errors
/// If the inelasticity is not in `[0, 1/2]`, or the temperature is not positive.
///
/// ```
/// use granular_edmd::kinetic::{effective_inelasticity, frictionless_energy_change};
/// let change = frictionless_energy_change(0.1, 2.0)?;
/// assert!((change + 0.72).abs() < 1e-15);
/// assert!((effective_inelasticity(change, 2.0)? - 0.1).abs() < 1e-15);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn frictionless_energy_change(inelasticity: f64, temperature: f64) -> Result<f64, ParameterError> {
    let inelasticity = Smooth::from_inelasticity(inelasticity)?.normal_inelasticity();
    Ok(-4.0 * inelasticity * (1.0 - inelasticity) * positive("temperature", temperature)?)
}
