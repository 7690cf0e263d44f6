//! The stress on walls.

use super::by_wall::ByWall;
use super::stretch::Stretch;
use super::table::{STRESS, Table, headings, row};
use super::{Collision, Heading, Observer, ObserverError, Partner, SampleTimes, Snapshot};
use crate::ParameterError;
use crate::quantity::positive;
use crate::statistics::{BlockedMean, Estimate};

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
/// up to three times too large. Choose intervals with many collisions.
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
        let received = Received { length, impulse: [0.0; 2], means: Default::default() };
        self.walls.insert(name.into(), received);
        Ok(self)
    }

    /// Returns the pressure on the wall of this name, or `None` if it is not watched.
    pub fn pressure(&self, name: &str) -> Option<Estimate> {
        self.walls.get(name).map(|wall| wall.means[0].estimate())
    }

    /// Returns the shear stress on the wall of this name, or `None` if it is not watched.
    pub fn shear(&self, name: &str) -> Option<Estimate> {
        self.walls.get(name).map(|wall| wall.means[1].estimate())
    }

    /// Forgets all measurements so far.
    pub fn clear(&mut self) {
        self.stretch.forget();
        for received in self.walls.values_mut() {
            (received.impulse, received.means) = ([0.0; 2], Default::default());
        }
    }
}

impl Observer for WallStress {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.walls.find(start)?;
        if self.stretch.begin(start) {
            self.walls.values_mut().for_each(|received| received.impulse = [0.0; 2]);
        }
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Wall(wall) = collision.partner else { return };
        if let Some(received) = self.walls.at(wall) {
            received.impulse[0] += collision.impulse.normal();
            received.impulse[1] -= collision.impulse.tangential();
        }
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let duration = self.stretch.finish(snapshot.time());
        for received in self.walls.values_mut() {
            let impulse = std::mem::take(&mut received.impulse);
            let Some(duration) = duration else { continue };
            for (mean, impulse) in received.means.iter_mut().zip(impulse) {
                mean.push(impulse / (received.length * duration));
            }
        }
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.stretch.pause(end.time());
    }
}

/// The walls are numbered in the order in which they were named.
impl Table for WallStress {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("wall", "1")], &[("pressure", STRESS), ("shear", STRESS)])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let estimates = |received: &Received| received.means.each_ref().map(BlockedMean::estimate);
        let numbered = (0..).map(f64::from).zip(self.walls.values());
        Box::new(numbered.map(move |(number, received)| row(&[number], &estimates(received))))
    }
}

crate::gate::from_file! {
    Received { length: f64, impulse: [f64; 2], means: [BlockedMean; 2] } =>
        Ok(Self { length: positive("length of a wall", length)?, impulse, means })
}
