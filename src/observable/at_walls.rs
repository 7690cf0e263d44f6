//! Stress that walls receive, and arrivals of disks at them.

use glam::DVec2;

use super::by_wall::ByWall;
use super::sample_times::Stretch;
use super::table::{STRESS, table};
use super::{Collision, Observer, ObserverError, Partner, SampleTimes, Snapshot};
use crate::ParameterError;
use crate::quantity::positive;
use crate::statistics::{BlockedMean, Estimate, block_average};

/// Smallest cosine between two normals that count as one direction.
const ALIKE: f64 = 0.999_999;

/// An observer of the pressure and the shear stress of the disks on walls.
///
/// ```math
/// p = \frac1{L\,t}\sum\Delta_n,\qquad \tau = -\frac1{L\,t}\sum\Delta_t,
/// ```
///
/// in units of energy per area, for a wall of length $`L`$ over a time $`t`$. $`\Delta_n`$ and $`\Delta_t`$
/// are the normal and tangential [impulses](crate::collision::Impulse) on the disks, so $`p`$ is positive
/// where disks push the wall. The shear stress $`\tau`$ is positive where disks drag the wall along the
/// tangent, which is the normal turned counterclockwise (to the left on a floor). Each interval between two
/// samples gives one value, and the errors come from blocks of these values. A disk that has hit a wall
/// cannot hit it again immediately, so the values of short intervals are anticorrelated, and their errors are
/// up to three times too large. So are the errors at the other walls of a container with a free lid, even
/// more: gas and lid give back what they take, and only the lid knows what it keeps.
///
/// A wall of the mass $`M`$ that disks push from one side gives back what they push: over a time $`t`$,
///
/// ```math
/// \sum\Delta_n = \int F\,dt - M\,\Delta V
/// ```
///
/// for the force $`F`$ on the wall and the change $`\Delta V`$ of its velocity, both along its normal. The
/// second term is bounded, so blocks of pressures would give errors that are far too large. The error is
/// therefore taken from blocks of $`\sum\Delta_n + M\Delta V`$ and from $`M\Delta V`$ between the first
/// sample and the last, whose variance is $`2M^2\langle V^2\rangle`$. A wall on a spring swings, and blocks
/// of a force that swings give errors that are up to twice too large.
///
/// One brick of a part has a name like "funnel, brick 2". A run ends with an error if its boundary has no
/// wall and no part of one of the names.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{SampleTimes, WallStress};
/// use granular_edmd::{Disk, Simulation};
///
/// // A ball of speed 3 bounces between floor and lid; its center moves 2 up and 2 down. Every 4/3, it
/// // gives the floor the impulse 3 + 3.
/// let container = Container::closed(5.0, 3.0)?;
/// let ball = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::new(0.0, 3.0))?;
/// let mut stress = WallStress::new(SampleTimes::every(4.0)?).with_wall("floor", 5.0)?;
/// Simulation::builder(Elastic, container).disks(vec![ball]).build()?.run_until(40.0, &mut stress)?;
/// assert!((stress.pressure("floor").unwrap().mean() - 4.5 / 5.0).abs() < 1e-12);
/// assert_eq!(stress.shear("floor").unwrap().mean(), 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct WallStress {
    stretch: Stretch,
    walls: ByWall<Received>,
}

/// The impulse that a wall received.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct Received {
    length: f64,
    /// Normal and tangential impulse since the latest sample.
    impulse: [f64; 2],
    means: [BlockedMean; 2],
    inertia: Inertia,
}

/// The motion of a wall with a mass, for the error of the pressure on it.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Inertia {
    /// Direction from the wall to the disks, once it is known; zero if they push from several sides.
    facing: Option<DVec2>,
    /// Momentum at the latest sample.
    momentum: DVec2,
    /// The pressures without the impulse that changed the momentum.
    loads: BlockedMean,
    /// Squares of the momentum along `facing`.
    squares: BlockedMean,
}

impl WallStress {
    /// Creates an observer that watches no wall yet and gives a value for each interval of the sample times.
    pub const fn new(times: SampleTimes) -> Self {
        Self { stretch: Stretch::new(times), walls: ByWall::NONE }
    }

    /// Returns the same observer, which also watches the wall or part of this name and length.
    ///
    /// # Errors
    /// If the length is not finite and positive.
    pub fn with_wall(mut self, name: impl Into<String>, length: f64) -> Result<Self, ParameterError> {
        let length = positive("length of a wall", length)?;
        let received = Received { length, ..Received::default() };
        self.walls.insert(name.into(), received);
        Ok(self)
    }

    /// Returns the pressure on the wall of this name, or `None` if it is not watched.
    pub fn pressure(&self, name: &str) -> Option<Estimate> {
        self.walls.get(name).map(|wall| wall.pressure(self.stretch.sample_times.interval()))
    }

    /// Returns the shear stress on the wall of this name, or `None` if it is not watched.
    pub fn shear(&self, name: &str) -> Option<Estimate> {
        self.walls.get(name).map(|wall| wall.means[1].estimate())
    }

    fn sample(&mut self, snapshot: &Snapshot<'_>, duration: Option<f64>) {
        for (wall, received) in self.walls.first_walls() {
            received.sample(snapshot.wall_momentum(wall), duration);
        }
    }
}

impl Received {
    /// Begins a new interval at which the wall has this momentum, if it has a mass, and takes the values of
    /// the interval before, of this duration, if that counts.
    fn sample(&mut self, momentum: Option<DVec2>, duration: Option<f64>) {
        let impulse = std::mem::take(&mut self.impulse);
        let now = momentum.unwrap_or_default();
        let gained = now - std::mem::replace(&mut self.inertia.momentum, now);
        let Some(duration) = duration else { return };
        let scale = self.length * duration;
        for (mean, impulse) in self.means.iter_mut().zip(impulse) {
            mean.push(impulse / scale);
        }
        if momentum.is_some() {
            let facing = self.inertia.facing.unwrap_or_default();
            self.inertia.loads.push((impulse[0] + gained.dot(facing)) / scale);
            self.inertia.squares.push(now.dot(facing) * now.dot(facing));
        }
    }

    /// Returns the pressure from values of intervals of this duration.
    fn pressure(&self, interval: f64) -> Estimate {
        /// Share of the error below which an error does not matter, whether it has converged or not.
        const SMALL: f64 = 0.3;
        let ([pressure, _], Inertia { facing, loads, squares, .. }) = (&self.means, &self.inertia);
        let (whole, naive) = (pressure.estimate(), pressure.ungrouped().standard_error());
        if loads.count() < 2 || naive == 0.0 || *facing == Some(DVec2::ZERO) {
            return whole;
        }
        let (load, square) = (loads.estimate(), squares.estimate());
        let swing = (2.0 * square.mean()).sqrt() / (self.length * interval * pressure.count() as f64);
        let error = libm::hypot(load.standard_error(), swing);
        let is_known = |share: f64, converged: bool| converged || share < SMALL * error;
        let converged =
            is_known(load.standard_error(), load.is_converged()) && is_known(swing, square.is_converged());
        let ratio = error / naive;
        Estimate::blocked(whole.mean(), error, whole.samples(), ratio * ratio, converged)
    }
}

impl Observer for WallStress {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.walls.find(start)?;
        if self.stretch.begin(start)? {
            self.sample(start, None);
        }
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Wall(wall) = collision.partner else { return };
        if let Some(received) = self.walls.at(wall) {
            received.impulse[0] += collision.impulse.normal();
            received.impulse[1] -= collision.impulse.tangential();
            let facing = received.inertia.facing.get_or_insert(collision.normal);
            if facing.dot(collision.normal) < ALIKE {
                *facing = DVec2::ZERO;
            }
        }
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let duration = self.stretch.finish(snapshot.time());
        self.sample(snapshot, duration);
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.stretch.pause(end.time());
    }
}

table! {
    /// The walls are numbered in the order in which they were named.
    WallStress, this: for (number, received) in (0..).map(f64::from).zip(this.walls.values());
    "wall" ["1"]: number;
    "pressure" [STRESS]: received.pressure(this.stretch.sample_times.interval()),
    "shear" [STRESS]: received.means[1].estimate()
}

crate::gate::from_file! {
    Received { length: f64, impulse: [f64; 2], means: [BlockedMean; 2], inertia: Inertia } =>
        Ok(Self { length: positive("length of a wall", length)?, impulse, means, inertia })
}

/// An observer that counts the disks that arrive at some walls, over intervals of time: the flow into a sink.
///
/// The rate of an interval of length $`\Delta t`$ with $`n`$ arrivals is $`n/\Delta t`$. An interval counts
/// only if it was watched from its start to its end. At a wall that is not a sink, each bounce is an arrival.
/// In an [`OfKind`](super::OfKind), only disks of one kind count.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::observable::Arrivals;
///
/// let exit = Part::polyline([(-1.0, 1.0), (5.0, 1.0)].map(DVec2::from))?.absorbing_centers();
/// let silo = Container::open(4.0)?.with_part("exit", exit)?;
/// // The centers come to the line every 1/4.
/// let grain = |k: f64| Disk::new(DVec2::new(2.0, 1.5 + k), 0.4)?.with_velocity(DVec2::new(0.0, -4.0));
/// let grains = (0..40).map(|k| grain(f64::from(k))).collect::<Result<Vec<_>, _>>()?;
/// let mut flow = Arrivals::at(["exit"], SampleTimes::every(1.0)?);
/// Simulation::builder(Elastic, silo).disks(grains).build()?.run_until(10.0, &mut flow)?;
/// assert_eq!(flow.counts(), [4; 10]);
/// assert_eq!(flow.rate()?.mean(), 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Arrivals {
    walls: ByWall<()>,
    stretch: Stretch,
    present: u64,
    times: Vec<f64>,
    counts: Vec<u64>,
}

impl Arrivals {
    /// Creates an observer of arrivals at the walls and parts of these names, counted over the intervals
    /// between these times.
    ///
    /// A run ends with an error if its boundary has no wall and no part of one of these names.
    pub fn at<N: Into<String>>(names: impl IntoIterator<Item = N>, times: SampleTimes) -> Self {
        let (mut walls, stretch) = (ByWall::NONE, Stretch::new(times));
        names.into_iter().for_each(|name| walls.insert(name.into(), ()));
        Self { walls, stretch, present: 0, times: Vec::new(), counts: Vec::new() }
    }

    /// Returns the ends of the intervals.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of arrivals in each interval.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Returns the mean number of arrivals per unit of time, with its error.
    ///
    /// Arrivals that are fed at regular times make up for each other from one interval to the next, and the
    /// error is then too large, up to tenfold: run several seeds for the true scatter.
    ///
    /// # Errors
    /// If no interval is complete yet.
    pub fn rate(&self) -> Result<Estimate, ParameterError> {
        block_average(&self.rates().collect::<Vec<_>>())
    }

    fn rates(&self) -> impl Iterator<Item = f64> {
        self.counts.iter().map(|&count| count as f64 / self.stretch.sample_times.interval())
    }
}

impl Observer for Arrivals {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.walls.find(start)?;
        if self.stretch.begin(start)? {
            self.present = 0;
        }
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Wall(wall) = collision.partner else { return };
        self.present += u64::from(self.walls.at(wall).is_some());
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let count = std::mem::take(&mut self.present);
        if self.stretch.finish(snapshot.time()).is_some() {
            self.times.push(snapshot.time());
            self.counts.push(count);
        }
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.stretch.pause(end.time());
    }
}

table! {
    /// The columns are the end of each interval, the number of arrivals in it, and their rate.
    Arrivals, this: for ((&time, &count), rate) in this.times.iter().zip(&this.counts).zip(this.rates());
    "time" ["time"]: time,
    "arrivals" ["1"]: count as f64,
    "rate" ["1/time"]: rate
}
