//! Transport coefficients, from the growth of Helfand's moments.

use glam::DVec2;

use super::lags::Lags;
use super::stretch::Stretch;
use super::table::{Table, headings, row};
use super::{Collision, Heading, Observer, Partner, SampleTimes, Snapshot, Verdict, contract};
use crate::boundary::Domain;
use crate::quantity::accept;
use crate::statistics::{BlockedMean, Estimate, RunningMean};
use crate::{Disk, ParameterError};

/// Largest rounding error of a velocity after many collisions, relative to the speed of sound.
const ROUNDING: f64 = 1e-6;

/// Number of moments: of shear, of compression and of heat. Each has two components.
const MOMENTS: usize = 3;

type Moments = [DVec2; MOMENTS];

/// An observer of the viscosities and the thermal conductivity of an elastic gas in a periodic box
/// (Helfand 1960; Alder, Gass and Wainwright 1970).
///
/// The moments describe the transport of momentum and energy, including transport by collisions: in a
/// collision, the momentum $`\vec\Delta`$ and the energy $`\Delta e`$ are carried instantaneously along the
/// vector $`\vec r`$ between the centers.
///
/// ```math
/// W_{ab}(t) = \int_0^t \sum_i m_i v_{i,a} v_{i,b}\,dt' + \sum_{\rm collisions}\Delta_a\, r_b ,
/// \qquad
/// \vec Q(t) = \int_0^t \sum_i e_i \vec v_i\,dt' + \sum_{\rm collisions}\Delta e\,\vec r .
/// ```
///
/// With the area $`A`$ and the temperature $`T`$, the coefficients are slopes over the second half of the
/// lags, as in [`MeanSquaredDisplacement`](super::MeanSquaredDisplacement):
///
/// ```math
/// \eta = \frac1{2AT}\frac{d}{dt}\langle W_{xy}^2\rangle, \qquad
/// \zeta = \frac1{2AT}\frac{d}{dt}\big\langle\big(\tfrac12(W_{xx}+W_{yy})-pAt\big)^2\big\rangle, \qquad
/// \lambda = \frac1{2AT^2}\frac{d}{dt}\langle Q_x^2\rangle .
/// ```
///
/// Both independent shears and both directions of heat are averaged, and shear uses the symmetric part of
/// $`W`$. Energy includes translation and rotation, so smooth and perfectly rough disks are possible, even
/// with couples that conserve the energy. Velocities are relative to the center of mass. All integrals are
/// exact; samples only set the lags.
///
/// Units: mass/time for the viscosities and, with k_B = 1, 1/time for the conductivity. In two dimensions the
/// slopes grow slowly with the longest lag, so report this lag and the number of disks. Choose lags from a
/// few mean free times up to the time in which sound crosses the box.
///
/// One observer measures one gas, in one run or in runs that continue each other. The first interval is as
/// long as the longest lag, and serves only to find the pressure. The errors come from blocks of origins.
///
/// A run ends with an error if
/// - it does not continue the previous run;
/// - the domain is not periodic in both directions, or has changed;
/// - there is gravity, or a disk meets a wall;
/// - a collision of disks changes the energy by more than 1e-6 of their energy;
/// - disks change by anything but collisions: an inlet, a driving, or a change between two runs. If only
///   their positions change between two runs, the observer begins with new origins.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::observable::{SampleTimes, TransportCoefficients};
/// use granular_edmd::{Simulation, initial};
///
/// // At a packing fraction of 0.05, Enskog's theory gives a viscosity of 0.298 for T = 1.
/// let container = Container::periodic(40.0, 40.0)?;
/// let disks = initial::random(&container, 102, 0.5, 40.0, 1)?;
/// let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
/// let mut transport = TransportCoefficients::new(20, SampleTimes::every(2.0)?)?;
/// Simulation::builder(Elastic, container).disks(disks).build()?.run_until(4000.0, &mut transport)?;
/// let viscosity = transport.shear_viscosity();
/// assert!((viscosity.mean() - 0.298).abs() < 0.06, "{viscosity}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct TransportCoefficients {
    stretch: Stretch,
    domain: Option<Domain>,
    /// The motions of the disks since the latest collision or sample; empty before the first sample.
    movers: Vec<Mover>,
    /// Time up to which the moments are known.
    time: f64,
    moments: Moments,
    /// Growth of the moments between two collisions.
    rates: Moments,
    /// Time and moment of compression at the start of the interval that finds the pressure.
    origin: Option<(f64, f64)>,
    /// Growth of the moment of compression by the pressure.
    drift: Option<f64>,
    lags: [Lags<DVec2>; MOMENTS],
    /// Slopes of the mean squared moments over the second half of the lags.
    slopes: [BlockedMean; MOMENTS],
    /// Growth of the moment of compression beyond the drift, over the longest lag.
    excess: RunningMean,
    temperature: RunningMean,
    /// The reason why the coefficients cannot be measured in this run.
    #[cfg_attr(feature = "serde", serde(skip))]
    fault: Option<ParameterError>,
}

/// The motion of a disk about the center of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Mover {
    velocity: DVec2,
    angular_velocity: f64,
    mass: f64,
    moment_of_inertia: f64,
    radius: f64,
}

impl Mover {
    fn new(disk: &Disk, frame: DVec2) -> Self {
        Self {
            velocity: disk.velocity() - frame,
            angular_velocity: disk.angular_velocity(),
            mass: disk.mass(),
            moment_of_inertia: disk.moment_of_inertia(),
            radius: disk.radius(),
        }
    }

    /// Returns whether two motions are the same up to this rounding of speeds.
    fn is_like(&self, other: &Self, rounding: f64) -> bool {
        let spin = (self.radius * (self.angular_velocity - other.angular_velocity)).abs();
        (self.mass, self.moment_of_inertia, self.radius)
            == (other.mass, other.moment_of_inertia, other.radius)
            && self.velocity.distance(other.velocity) <= rounding
            && spin <= rounding
    }

    fn energy(&self) -> f64 {
        0.5 * (self.mass * self.velocity.length_squared()
            + self.moment_of_inertia * self.angular_velocity * self.angular_velocity)
    }

    /// Returns the contribution of this disk to the rates.
    fn rates(&self) -> Moments {
        let Self { velocity, mass, .. } = *self;
        of_tensor(mass * velocity, velocity, self.energy() * velocity)
    }

    /// Changes the motion by an impulse and a couple, and returns the change of the energy. Both partners get
    /// the same sense of rotation from a tangential impulse, since they are on opposite sides of the contact.
    fn kick(&mut self, impulse: DVec2, tangential: f64, couple: f64) -> f64 {
        let before = self.energy();
        self.velocity += impulse / self.mass;
        self.angular_velocity -= (tangential * self.radius + couple) / self.moment_of_inertia;
        self.energy() - before
    }
}

/// Returns the moments of momentum and heat that are carried along a vector. Shear has two components that
/// are equal in an isotropic gas; compression has one component, which is stored twice.
fn of_tensor(momentum: DVec2, way: DVec2, heat: DVec2) -> Moments {
    let (xx, yy) = (momentum.x * way.x, momentum.y * way.y);
    let shear = 0.5 * (momentum.x * way.y + momentum.y * way.x);
    [DVec2::new(shear, 0.5 * (xx - yy)), DVec2::splat(0.5 * (xx + yy)), heat]
}

fn add(sum: &mut Moments, part: &Moments, factor: f64) {
    for (sum, part) in sum.iter_mut().zip(part) {
        *sum += factor * *part;
    }
}

impl TransportCoefficients {
    /// Creates an observer with slopes over the second half of this number of intervals of the sample times.
    ///
    /// # Errors
    /// If the number of lags is not in `2..=2^20`.
    pub fn new(lags: usize, times: SampleTimes) -> Result<Self, ParameterError> {
        accept(lags >= 2, "number of lags", "in 2..=2^20", lags as f64)?;
        let lags = Lags::new(times, lags)?;
        Ok(Self {
            stretch: Stretch::new(times),
            domain: None,
            movers: Vec::new(),
            time: 0.0,
            moments: [DVec2::ZERO; MOMENTS],
            rates: [DVec2::ZERO; MOMENTS],
            origin: None,
            drift: None,
            lags: [lags.clone(), lags.clone(), lags],
            slopes: std::array::from_fn(|_| BlockedMean::new()),
            excess: RunningMean::default(),
            temperature: RunningMean::default(),
            fault: None,
        })
    }

    /// Returns the shear viscosity η.
    pub fn shear_viscosity(&self) -> Estimate {
        self.coefficient(0, 0.0)
    }

    /// Returns the bulk viscosity ζ.
    pub fn bulk_viscosity(&self) -> Estimate {
        // The pressure in the first interval differs slightly from the pressure in the whole run. The square
        // of this difference adds to the growth of the moment's mean square, but is not part of the
        // viscosity.
        let interval = self.stretch.sample_times.interval();
        let (longest, half) = (self.lags[1].longest(), self.lags[1].longest() / 2);
        let excess = self.excess.mean() / (longest as f64 * interval);
        self.coefficient(1, excess * excess * (longest + half) as f64 * interval)
    }

    /// Returns the thermal conductivity λ for disks of equal mass, or NaN for disks of different masses,
    /// whose diffusion also carries energy.
    pub fn thermal_conductivity(&self) -> Estimate {
        self.coefficient(2, 0.0).scaled(1.0 / self.temperature())
    }

    /// Iterates over the lags as times, with the mean squared moments of shear and of heat, which show where
    /// the moments grow linearly.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, [Estimate; 2])> {
        self.lags[0].iter().zip(self.lags[2].iter()).map(|((time, shear), (_, heat))| (time, [shear, heat]))
    }

    /// Returns the mean translational temperature about the center of mass: twice the energy divided by the
    /// $`2(N-1)`$ degrees of freedom.
    pub fn temperature(&self) -> f64 {
        self.temperature.mean()
    }

    fn coefficient(&self, moment: usize, less: f64) -> Estimate {
        let area = self.domain.map_or(f64::NAN, |domain| domain.width() * domain.height());
        let slope = self.slopes[moment].estimate();
        let mean = slope.mean() - less;
        slope.about(mean).scaled(0.5 / (area * self.temperature()))
    }

    /// Advances the moments to a time.
    fn advance(&mut self, time: f64) {
        let rates = self.rates;
        add(&mut self.moments, &rates, time - self.time);
        self.time = time;
    }

    /// Stores the motions of this snapshot, and checks that they equal the expected motions up to rounding,
    /// as they do if only collisions have changed them. Otherwise, keeps the old motions, so that further
    /// runs are refused, too.
    fn take_motions(&mut self, disks: &[Disk]) {
        let mass: f64 = disks.iter().map(Disk::mass).sum();
        let frame = disks.iter().map(|disk| disk.mass() * disk.velocity()).sum::<DVec2>() / mass;
        let movers: Vec<Mover> = disks.iter().map(|disk| Mover::new(disk, frame)).collect();
        let energy: f64 = movers.iter().map(|mover| mover.mass * mover.velocity.length_squared()).sum();
        let thermal = 2.0 * movers.iter().map(Mover::energy).sum::<f64>() / mass;
        let same = |(one, other): (&Mover, &Mover)| one.is_like(other, ROUNDING * thermal.sqrt());
        let are_same = self.movers.len() == movers.len() && self.movers.iter().zip(&movers).all(same);
        if !self.movers.is_empty() && !are_same {
            let name = "time by which disks have changed otherwise than in collisions";
            self.fault = Some(ParameterError::new(name, "never, for transport coefficients", self.time));
            return;
        }
        self.rates = [DVec2::ZERO; MOMENTS];
        for mover in &movers {
            add(&mut self.rates, &mover.rates(), 1.0);
        }
        self.temperature.push(energy / (2.0 * movers.len().saturating_sub(1) as f64));
        self.movers = movers;
    }

    /// Returns whether the pressure is known. The interval that finds it is as long as the longest lag.
    fn knows_pressure(&mut self) -> bool {
        let compression = self.moments[1].x;
        let (start, at_start) = *self.origin.get_or_insert((self.time, compression));
        let longest = (self.lags[1].longest() as f64 - 0.5) * self.stretch.sample_times.interval();
        if self.drift.is_none() && self.time - start > longest {
            self.drift = Some((compression - at_start) / (self.time - start));
        }
        self.drift.is_some()
    }

    fn take_sample(&mut self) {
        let Some(drift) = self.drift else { return };
        let mut sample = self.moments;
        sample[1] -= drift * self.time;
        let equal = self.movers.windows(2).all(|two| two[0].mass == two[1].mass);
        let moments = if equal { MOMENTS } else { 2 };
        for index in 0..moments {
            let lags = &mut self.lags[index];
            lags.push(self.time, sample[index], |one, other| 0.5 * one.distance_squared(*other));
            let (longest, half) = (lags.longest(), lags.longest() / 2);
            if let (Some(first), Some(middle)) = (lags.before(longest), lags.before(half)) {
                let squared = |from: &DVec2| 0.5 * sample[index].distance_squared(*from);
                let time = (longest - half) as f64 * self.stretch.sample_times.interval();
                self.slopes[index].push((squared(first) - squared(middle)) / time);
                if index == 1 {
                    self.excess.push(sample[1].x - first.x);
                }
            }
        }
    }
}

impl Observer for TransportCoefficients {
    fn on_start(&mut self, start: &Snapshot<'_>) {
        let periods = start.domain().periods();
        let periodic =
            accept(periods.min_element() > 0.0, "period of the domain", "positive", periods.min_element());
        let gravity = start.gravity().larger();
        let weightless = accept(gravity == 0.0, "gravity", "0 for transport coefficients", gravity);
        let (begins, is_first) = (self.stretch.begin(start), self.domain.is_none());
        let (name, previous) =
            ("start of the run", "the end of the previous one, for transport coefficients");
        let goes_on = accept(is_first || !begins, name, previous, start.time());
        let area = start.domain().width() * start.domain().height();
        let domain = *self.domain.get_or_insert(start.domain());
        let (name, same) = ("area of the domain", "that of the previous run, for transport coefficients");
        let stays = accept(domain == start.domain(), name, same, area);
        self.fault = periodic.and(weightless).and(stays).and(goes_on).err();
        for lags in &mut self.lags {
            lags.begin(start);
        }
    }

    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Disk(partner) = collision.partner else {
            let (name, never) = ("time of a collision with a wall", "never, for transport coefficients");
            self.fault = Some(ParameterError::new(name, never, collision.time));
            return;
        };
        let pair = (self.movers.get(collision.disk).copied(), self.movers.get(partner).copied());
        let (Some(mut first), Some(mut second)) = pair else { return };
        self.advance(collision.time);
        let (normal, impulse) = (collision.normal, collision.impulse);
        let kick = normal * impulse.normal() + normal.perp() * impulse.tangential();
        for mover in [&first, &second] {
            add(&mut self.rates, &mover.rates(), -1.0);
        }
        let energy = first.energy() + second.energy();
        if collision.energy_change.abs() > ROUNDING * energy {
            let (name, lost) = ("energy lost in a collision", -collision.energy_change);
            self.fault = Some(ParameterError::new(name, "0 for transport coefficients", lost));
        }
        let gained = first.kick(kick, impulse.tangential(), impulse.couple());
        let lost = second.kick(-kick, impulse.tangential(), -impulse.couple());
        for mover in [&first, &second] {
            add(&mut self.rates, &mover.rates(), 1.0);
        }
        let way = normal * collision.distance;
        add(&mut self.moments, &of_tensor(kick, way, 0.5 * (gained - lost) * way), 1.0);
        (self.movers[collision.disk], self.movers[partner]) = (first, second);
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.advance(snapshot.time());
        self.take_motions(snapshot.disks());
        if self.fault.is_none() && self.knows_pressure() {
            self.take_sample();
        }
        self.stretch.finish(snapshot.time());
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.advance(end.time());
        self.stretch.pause(end.time());
        for lags in &mut self.lags {
            lags.pause(end);
        }
    }

    fn verdict(&mut self) -> Verdict {
        contract::verdict(&mut self.fault)
    }
}

impl Table for TransportCoefficients {
    fn headings(&self) -> Vec<Heading> {
        let moments =
            [("shear_moment", "(mass length^2/time)^2"), ("heat_moment", "(mass length^3/time^2)^2")];
        headings(&[("time", "time")], &moments)
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|(time, moments)| row(&[time], &moments)))
    }
}
