//! Warnings: facts that a run noticed and survived.

use std::fmt;

use glam::DVec2;

use super::engine::Engine;
use super::{Counters, Inlet, Simulation};
use crate::boundary::{Boundary, Region};
use crate::collision::CollisionRule;
use crate::error::Rounded;
use crate::observable::{Partner, Temperatures};
use crate::scheduler::EventScheduler;

/// Fewest collisions for which a share is meaningful.
const FEWEST: u64 = 1000;

/// Smallest contact duration that counts as long, relative to the time between two collisions of a disk.
const LONG: f64 = 0.05;

/// Distance that a typical disk moves in the contact duration, in diameters, below which matter is at rest.
const FAR: f64 = 0.005;

/// Largest speed across an axis, relative to the speed along the axis, that counts as zero.
const STRAIGHT: f64 = 1e-9;

/// Largest relative gain of energy that counts as rounding.
const GAIN: f64 = 1e-9;

/// Smallest energy that stops absorb, relative to the energy of the disks, that matters.
const ABSORBED: f64 = 0.01;

/// Fewest disks at an inlet that count as a jam.
const JAM: usize = 1000;

/// A fact that a run noticed and survived, and that its caller may not have wanted.
///
/// Warnings about shares and directions of collisions come only after a thousand collisions. Some warnings
/// follow from the [`Counters`] alone, so records of studies have them, too; the others come from the
/// simulation itself ([`Simulation::warnings`]).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The contact duration is not short compared with the time between the collisions of a disk: by Luding's
    /// criterion, $`t_c\,\omega_c \ll 1`$, where $`\omega_c`$ is the rate of the collisions that the model
    /// did not change. The model removes a share of about $`2.25\,t_c\,\omega_c`$ of the dissipation from a
    /// flow.
    LongContactDuration {
        /// The contact duration, as estimated from the collisions, times the rate of a disk's collisions.
        share_of_time: f64,
        /// Number of collisions that the contact-duration model made elastic.
        elastic: u64,
        /// Number of all collisions, with disks or walls.
        collisions: u64,
    },
    /// More than half of the collisions parted at the least speed of
    /// [`LeastRebound`](crate::collision::LeastRebound). In matter at rest, this is its purpose. In a flow,
    /// the speed is too high, and the energy that it adds keeps the disks moving.
    MostlyLeastRebound {
        /// Number of collisions that the remedy decided.
        raised: u64,
        /// Number of all collisions, with disks or walls.
        collisions: u64,
        /// Energy added by the remedy.
        energy: f64,
    },
    /// All disks move along one axis only, although a thousand collisions between disks or more have
    /// happened: they started in line, and nothing pushes them aside. Rows of a lattice over a floor that
    /// moves vertically bounce like this forever. Small velocities at the start prevent this, for example
    /// from [`with_maxwellian_velocities`](crate::initial::with_maxwellian_velocities).
    OneDirection {
        /// Number of collisions, with disks or walls.
        collisions: u64,
    },
    /// Gravity points upwards, the boundary is open there, and a disk has no wall of any kind above it: disks
    /// that fall out never come back, and the run becomes slower and slower.
    EndlessFall {
        /// Upward component of gravity.
        upwards: f64,
    },
    /// The disks have gained energy since the run was built, or since disks, walls or gravity were last
    /// changed between two runs or by the kick of a driving, though no wall moves or is warm, and no disk
    /// came in or left: a rule gains energy. [`collision::laws::check`](crate::collision::laws::check) finds
    /// such a rule.
    EnergyGained {
        /// Energy at that time, and what [`LeastRebound`](crate::collision::LeastRebound) has added since.
        before: f64,
        /// Energy now.
        now: f64,
    },
    /// A wall with a mass was hit while it rested on a stop, or flew into one after a hit. The stop absorbs
    /// what the disks give the wall, so they lose energy under any rule ([`Piston`](crate::wall::Piston)).
    /// The warning comes if stops have absorbed a hundredth of the energy of the disks or more, potential
    /// energy above the bottom of the domain included, since the simulation was built or resumed, or since
    /// disks or walls were last changed between two runs.
    WallOnStop {
        /// The name of the last such wall.
        wall: String,
        /// Energy that stops have absorbed.
        energy: f64,
    },
    /// A thousand disks or more wait at an inlet. The inlet may have no room at all, for example if it lies
    /// inside a part.
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
            Self::LongContactDuration { share_of_time, elastic, collisions } => write!(
                formatter,
                "the contact duration is {} times the time between two collisions of a disk ({elastic} of {collisions} \
                 collisions lost nothing), so it removes about {} % of the dissipation; a shorter one is needed",
                Rounded(*share_of_time),
                Rounded((225.0 * share_of_time).min(100.0))
            ),
            Self::MostlyLeastRebound { raised, collisions, energy } => write!(
                formatter,
                "{raised} of {collisions} collisions parted at the least speed of LeastRebound, which added the \
                 energy {}: right for matter at rest, but in a flow the speed is too high",
                Rounded(*energy)
            ),
            Self::OneDirection { collisions } => write!(
                formatter,
                "after {collisions} collisions all disks still move along one axis only: they started in line; give \
                 them small velocities in all directions"
            ),
            Self::EndlessFall { upwards } => write!(
                formatter,
                "gravity points upwards by {} where there is no lid: disks fall forever, and each step of the clock takes \
                 more events; a lid or another gravity is needed",
                Rounded(*upwards)
            ),
            Self::EnergyGained { before, now } => write!(
                formatter,
                "the energy grew from {} to {} without a source: a rule gains energy; see collision::laws::check",
                Rounded(*before),
                Rounded(*now)
            ),
            Self::WallOnStop { wall, energy } => write!(
                formatter,
                "the wall {wall:?} rested on a stop or flew into one, and stops absorbed the energy {}: a disk of mass m leaves \
                 a wall of mass M that rests with (M - m)/(M + m) of its speed, under any rule",
                Rounded(*energy)
            ),
            Self::DisksWait { inlet, waiting } => write!(
                formatter,
                "{waiting} disks wait at inlet {inlet}: disks or walls fill its room, or it opens too often"
            ),
        }
    }
}

impl Counters {
    /// Returns the warnings that follow from these counts.
    ///
    /// ```
    /// use granular_edmd::boundary::Container;
    /// use granular_edmd::collision::{LeastRebound, Smooth};
    /// use granular_edmd::simulation::Warning;
    /// use granular_edmd::{Simulation, initial};
    ///
    /// let container = Container::closed(20.0, 20.0)?;
    /// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 1.0, 1)?;
    /// let rule = LeastRebound::new(Smooth::from_restitution(0.9)?, 10.0)?;
    /// let mut run = Simulation::builder(rule, container).disks(disks).build()?;
    /// run.run_until(100.0, &mut ())?;
    /// assert!(matches!(run.counters().warnings()[..], [Warning::MostlyLeastRebound { .. }]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn warnings(&self) -> Vec<Warning> {
        let (raised, collisions) = (self.least_rebound_collisions, self.collisions());
        let is_mostly_raised = collisions >= FEWEST && raised > collisions / 2;
        let energy = self.energy_of_rebounds;
        let raised = is_mostly_raised.then_some(Warning::MostlyLeastRebound { raised, collisions, energy });
        raised.into_iter().collect()
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the warnings about the simulation since it was built: the warnings of its
    /// [`counters`](Self::counters), and warnings that depend on the state of the simulation.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = self.engine.counters.warnings();
        let waiting = self.engine.inlets.iter().map(Inlet::waiting).enumerate();
        let crowded = waiting.filter(|&(_, waiting)| waiting >= JAM);
        warnings.extend(crowded.map(|(inlet, waiting)| Warning::DisksWait { inlet, waiting }));
        warnings.extend(self.long_contact_duration());
        warnings.extend(self.engine.one_direction());
        warnings.extend(self.endless_fall());
        warnings.extend(self.energy_gained());
        warnings.extend(self.wall_on_stop());
        warnings
    }

    fn wall_on_stop(&self) -> Option<Warning> {
        let (wall, energy) = self.engine.stopped?;
        let [_, size] = self.engine.bodies.energy(self.engine.clock.now, &self.parts.boundary.domain());
        let wall = self.name_of(Partner::Wall(wall))?;
        (energy > ABSORBED * size).then_some(Warning::WallOnStop { wall, energy })
    }

    fn long_contact_duration(&self) -> Option<Warning> {
        let Counters { contact_duration_collisions: elastic, longest_contact, .. } = self.engine.counters;
        let collisions = self.engine.counters.collisions();
        let disk_time = self.engine.ledger.disk_time_at(self.time(), self.len());
        // Both disks take part in a collision of two, but only one in a collision with a wall.
        let partners = 1.0 + self.engine.counters.disk_collisions as f64 / collisions.max(1) as f64;
        let rate = |count: u64| partners * count as f64 / disk_time;
        let free = longest_contact * rate(collisions - elastic);
        let way = longest_contact * self.measure(&Temperatures).translational().sqrt();
        let way = way / self.engine.bodies.typical_diameter;
        // In matter that collapses, the model decides most collisions on purpose; such matter is recognized
        // because its disks hardly move in the contact duration. In a flow, the model may decide nearly all
        // collisions, too. Few others are then left, so all collisions are counted.
        let is_flow = way > FAR;
        let share_of_time = if elastic > collisions / 2 { longest_contact * rate(collisions) } else { free };
        let is_long = collisions >= FEWEST && is_flow && share_of_time > LONG;
        is_long.then_some(Warning::LongContactDuration { share_of_time, elastic, collisions })
    }

    fn endless_fall(&self) -> Option<Warning> {
        let upwards = self.gravity().acceleration().y;
        let is_open = upwards > 0.0 && self.parts.boundary.domain().top.is_infinite();
        (is_open && (0..self.len()).any(|disk| self.has_no_wall_above(disk)))
            .then_some(Warning::EndlessFall { upwards })
    }

    /// Returns whether a disk that moves straight up can never touch a wall. A part of the boundary may be a
    /// lid.
    fn has_no_wall_above(&self, disk: usize) -> bool {
        let (place, radius) =
            (self.engine.bodies.position(disk, self.engine.clock.now), self.engine.bodies.radius(disk));
        // The region begins a diameter above the center, so that the floor on which a disk lies is not in it.
        let above = Region::new(place + 2.0 * radius * DVec2::Y, DVec2::new(place.x, f64::INFINITY));
        !self.parts.boundary.may_touch(&above, radius)
    }

    fn energy_gained(&self) -> Option<Warning> {
        let [now, size] = self.engine.bodies.energy(self.engine.clock.now, &self.parts.boundary.domain());
        let rebounds = self.engine.counters.energy_of_rebounds;
        let before = self.engine.ledger.energy + rebounds;
        // Disks that fall forever have large energies of both kinds, whose rounding may exceed their sum.
        let is_more = now - before > GAIN * (size + before.abs() + rebounds);
        (!self.engine.ledger.has_source && is_more).then_some(Warning::EnergyGained { before, now })
    }
}

impl Engine {
    fn one_direction(&self) -> Option<Warning> {
        let collisions = self.counters.disk_collisions;
        let speeds = (0..self.len()).map(|disk| self.bodies.velocity(disk, self.clock.now).abs());
        let DVec2 { x, y } = speeds.fold(DVec2::ZERO, DVec2::max);
        // For a single disk, and for disks that were brought to rest, motion along one axis is no reason for
        // a warning.
        let may_be = collisions >= FEWEST && self.len() > 1 && x.max(y) > 0.0;
        let is_one = may_be && x.min(y) <= STRAIGHT * x.max(y);
        is_one.then_some(Warning::OneDirection { collisions: self.counters.collisions() })
    }
}
