//! The stress on walls.

use std::collections::BTreeMap;

use super::stretch::Stretch;
use super::table::{STRESS, Table, headings, row};
use super::wall_names::{WallNames, check_walls};
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
/// A run ends with an error if an index names no wall, or a wall with another
/// [name](crate::boundary::Boundary::wall_name) than before.
///
/// ```
/// use granular_edmd::boundary::{Container, Wall};
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{SampleTimes, WallStress};
/// use granular_edmd::{Disk, Simulation};
///
/// // A ball of speed 3 bounces between floor and lid; its center moves 2 up and 2 down. Every 4/3, it
/// // gives the floor the impulse 3 + 3.
/// let container = Container::closed(5.0, 3.0)?;
/// let floor = container.index(Wall::Floor).unwrap();
/// let ball = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::new(0.0, 3.0))?;
/// let mut stress = WallStress::new(SampleTimes::every(4.0)?).with_wall(floor, 5.0)?;
/// Simulation::builder(Elastic, container).disks(vec![ball]).build()?.run_until(40.0, &mut stress)?;
/// assert!((stress.pressure(floor).unwrap().mean() - 4.5 / 5.0).abs() < 1e-12);
/// assert_eq!(stress.shear(floor).unwrap().mean(), 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct WallStress {
    stretch: Stretch,
    walls: BTreeMap<usize, Received>,
    names: WallNames,
}

/// The impulse that a wall received.
#[derive(Debug, Clone, PartialEq)]
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
        Self { stretch: Stretch::new(times), walls: BTreeMap::new(), names: WallNames::NONE }
    }

    /// Returns the same observer, which also watches the wall of this index and length.
    ///
    /// # Errors
    /// If the length is not finite and positive.
    pub fn with_wall(mut self, wall: usize, length: f64) -> Result<Self, ParameterError> {
        let length = positive("length of a wall", length)?;
        let received = Received { length, impulse: [0.0; 2], means: Default::default() };
        self.walls.insert(wall, received);
        Ok(self)
    }

    /// Returns the pressure on a wall, or `None` if the wall is not watched.
    pub fn pressure(&self, wall: usize) -> Option<Estimate> {
        self.walls.get(&wall).map(|wall| wall.means[0].estimate())
    }

    /// Returns the shear stress on a wall, or `None` if the wall is not watched.
    pub fn shear(&self, wall: usize) -> Option<Estimate> {
        self.walls.get(&wall).map(|wall| wall.means[1].estimate())
    }

    /// Forgets all measurements so far.
    pub fn clear(&mut self) {
        self.stretch.forget();
        self.names = WallNames::default();
        for received in self.walls.values_mut() {
            (received.impulse, received.means) = ([0.0; 2], Default::default());
        }
    }
}

impl Observer for WallStress {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        check_walls(start, self.walls.keys())?;
        self.names.check(start, |wall| self.walls.contains_key(&wall))?;
        if self.stretch.begin(start) {
            self.walls.values_mut().for_each(|received| received.impulse = [0.0; 2]);
        }
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        let Partner::Wall(wall) = collision.partner else { return };
        if let Some(received) = self.walls.get_mut(&wall) {
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

impl Table for WallStress {
    fn headings(&self) -> Vec<Heading> {
        headings(&[("wall", "1")], &[("pressure", STRESS), ("shear", STRESS)])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let estimates = |received: &Received| received.means.each_ref().map(BlockedMean::estimate);
        Box::new(self.walls.iter().map(move |(&wall, received)| row(&[wall as f64], &estimates(received))))
    }
}

crate::gate::from_file! {
    Received { length: f64, impulse: [f64; 2], means: [BlockedMean; 2] } =>
        Ok(Self { length: positive("length of a wall", length)?, impulse, means })
}
