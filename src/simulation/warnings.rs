//! Warnings: what a run noticed and survived.

use std::collections::BTreeMap;
use std::fmt;

use glam::DVec2;

use super::errors::named;
use super::{Counters, Inlet, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::error::Rounded;
use crate::observable::Partner;
use crate::scheduler::EventScheduler;

/// Fewest collisions of which a share says something.
const FEWEST: u64 = 1000;

/// Fewest disks at an inlet that count as a jam.
const JAM: usize = 1000;

/// Way of a wall that counts as a jump, relative to a typical diameter.
const JUMP: f64 = 1e-6;

/// A fact that a run noticed and survived, and that its caller may not have wanted.
///
/// Warnings follow from the [`Counters`], so checkpoints and records of studies have them, too; only those
/// about inlets come from the simulation itself.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A wall was elsewhere at once when the boundary was set between two runs, and hit no disk. A motion
    /// that begins at another phase is a usual cause; see [`StartingAt`](crate::wall::StartingAt).
    WallJumped {
        /// The wall that jumped farthest.
        wall: usize,
        /// The name of that wall, if the simulation was asked.
        name: Option<String>,
        /// The way of that wall.
        by: f64,
        /// Number of jumps of all walls.
        jumps: u64,
    },
    /// More than half of the collisions were elastic, since they came within the contact duration of the last
    /// ones. In matter at rest this is what a contact duration is for. In a flow, it is longer than the time
    /// between collisions, and the rule hardly ever applies.
    MostlyContactDuration {
        /// Number of collisions that the contact-duration model made elastic.
        elastic: u64,
        /// Number of all collisions, with disks or walls.
        collisions: u64,
    },
    /// A thousand disks or more wait at an inlet. It may have no room at all, as inside of a part.
    DisksWait {
        /// Index of the inlet.
        inlet: usize,
        /// Number of disks that wait there.
        waiting: usize,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WallJumped { wall, name, by, jumps } => write!(
                formatter,
                "walls jumped {jumps} times when the boundary was set, the farthest by {}{}; \
                 StartingAt lets a motion begin where it should",
                Rounded(*by),
                named(Some(Partner::Wall(*wall)), name.as_deref())
            ),
            Self::MostlyContactDuration { elastic, collisions } => write!(
                formatter,
                "{elastic} of {collisions} collisions lost nothing, since they came within the contact duration: \
                 it is longer than the time between collisions, or matter is at rest"
            ),
            Self::DisksWait { inlet, waiting } => write!(
                formatter,
                "{waiting} disks wait at inlet {inlet}: disks or walls take its room, or it opens too often"
            ),
        }
    }
}

impl Counters {
    /// Returns what these counts warn of.
    ///
    /// ```
    /// use granular_edmd::boundary::Container;
    /// use granular_edmd::collision::{ContactDuration, Smooth};
    /// use granular_edmd::simulation::Warning;
    /// use granular_edmd::{Simulation, initial};
    ///
    /// let container = Container::closed(20.0, 20.0)?;
    /// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 1.0, 1)?;
    /// let rule = ContactDuration::new(Smooth::from_restitution(0.9)?, 1000.0)?;
    /// let mut run = Simulation::builder(rule, container).disks(disks).build()?;
    /// run.run_until(100.0, &mut ())?;
    /// assert!(matches!(run.warnings()[..], [Warning::MostlyContactDuration { .. }]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn warnings(&self) -> Vec<Warning> {
        let Self { contact_duration_collisions: elastic, jumped_wall, farthest_jump: by, .. } = *self;
        let (jumps, wall) = (self.wall_jumps, usize::from(jumped_wall));
        let jumped = (jumps > 0).then_some(Warning::WallJumped { wall, name: None, by, jumps });
        let collisions = self.collisions();
        let is_mostly_elastic = collisions >= FEWEST && elastic > collisions / 2;
        let elastic = is_mostly_elastic.then_some(Warning::MostlyContactDuration { elastic, collisions });
        jumped.into_iter().chain(elastic).collect()
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns what the simulation noticed and survived since it was built: the warnings of its
    /// [`counters`](Self::counters), with the names of walls, and those about its inlets.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = self.counters.warnings();
        for warning in &mut warnings {
            if let Warning::WallJumped { wall, name, .. } = warning {
                *name = self.name_of(Partner::Wall(*wall));
            }
        }
        let waiting = self.inlets.iter().map(Inlet::waiting).enumerate();
        let crowded = waiting.filter(|&(_, waiting)| waiting >= JAM);
        warnings.extend(crowded.map(|(inlet, waiting)| Warning::DisksWait { inlet, waiting }));
        warnings
    }

    /// Counts the walls that are elsewhere in another boundary at this moment. Walls are the same if their
    /// names are.
    pub(super) fn count_jumps(&mut self, other: &impl Boundary) {
        let before = places(&self.boundary, self.clock.now);
        for (name, (wall, here)) in places(other, self.clock.now) {
            let by = before.get(&name).map_or(0.0, |(_, there)| there.distance(here));
            if by > JUMP * self.bodies.typical_diameter {
                self.counters.wall_jumps += 1;
                if by > self.counters.farthest_jump {
                    (self.counters.farthest_jump, self.counters.jumped_wall) = (by, wall as u16);
                }
            }
        }
    }
}

/// Returns the walls of a boundary by name, each with its index and its place. Of walls of one name, such as
/// the parts of a gate, the first is enough. The map is sorted, so that the count is the same on every run.
fn places<B: Boundary>(boundary: &B, time: f64) -> BTreeMap<String, (usize, DVec2)> {
    let mut places = BTreeMap::new();
    for wall in 0..boundary.wall_count() {
        if let Some(place) = boundary.wall_point(wall, time) {
            places.entry(boundary.wall_name(wall).into_owned()).or_insert((wall, place));
        }
    }
    places
}
