//! The Maxwellian gas whose collisions are averaged.

use crate::collision::Contact;
use crate::disk::{SCALE, scale};
use crate::quantity::accept;
use crate::{Disk, Kind, ParameterError};

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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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

crate::gate::from_file! {
    Maxwellian {
        translational_temperature: f64,
        rotational_temperature: f64,
        masses: [f64; 2],
        inertia_factors: [f64; 2],
        radii: [f64; 2],
        kinds: [Kind; 2]
     } => {
        let partner = |index: usize| {
            let disk = Disk::new(glam::DVec2::ZERO, radii[index])?.with_kind(kinds[index]);
            disk.with_mass(masses[index])?.with_inertia_factor(inertia_factors[index])
        };
        Ok(Self::new(translational_temperature)?
            .with_rotational_temperature(rotational_temperature)?
            .with_partners(&partner(0)?, &partner(1)?))
    }
}
