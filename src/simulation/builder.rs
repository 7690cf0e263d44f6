//! The builder, which checks all inputs once and makes a simulation of them.

use glam::DVec2;

use super::cells::{CellSize, Cells};
use super::engine::{Engine, Parts};
use super::state::{Bodies, Clock, Identities, Ledger};
use super::{BuildError, Simulation};
use crate::boundary::{Boundary, Domain, Overlap, Probe, WallView};
use crate::collision::CollisionRule;
use crate::disk::{TOUCHING, countable};
use crate::quantity::{accept, finite};
use crate::scheduler::{BySize, EventScheduler};
use crate::{Disk, Gravity, ParameterError};

/// Smallest allowed speed other than 0. The square of a smaller speed would be rounded to 0, and no collision
/// of the disk would be found.
const SLOWEST: f64 = 1e-100;

/// Largest spacing of numbers near the position of a disk, relative to its radius. Coarser positions would
/// turn the normals of collisions, without an overlap that the engine could notice.
const COARSEST: f64 = 1e-3;

/// Largest number of walls that a boundary may have.
const MOST_WALLS: usize = 1 << 16;

/// The inputs of a simulation that is being built; see [`Simulation::builder`].
#[derive(Debug, Clone)]
#[must_use]
pub struct SimulationBuilder<R, B, S = BySize> {
    rule: R,
    boundary: B,
    scheduler: S,
    disks: Vec<Disk>,
    gravity: Gravity,
    seed: u64,
    start_time: f64,
}

impl<R: CollisionRule, B: Boundary> Simulation<R, B, BySize> {
    /// Starts to build a simulation from the collision rule of the disks and the walls around the disks.
    ///
    /// The rule also applies to walls without their own rule.
    ///
    /// ```
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::boundary::Container;
    /// use granular_edmd::collision::Frictional;
    /// use granular_edmd::{Disk, Simulation};
    ///
    /// let disks = vec![Disk::new(DVec2::new(2.0, 1.0), 0.5)?, Disk::new(DVec2::new(2.2, 3.0), 0.5)?];
    /// let rule = Frictional::from_inelasticity(0.1, 0.1, 0.3)?;
    /// let mut simulation = Simulation::builder(rule, Container::open(4.0)?)
    ///     .disks(disks)
    ///     .gravity(1.0)
    ///     .build()?;
    /// simulation.run_until(2.0, &mut ())?;
    /// assert!(simulation.counters().disk_collisions > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn builder(rule: R, boundary: B) -> SimulationBuilder<R, B> {
        SimulationBuilder {
            rule,
            boundary,
            scheduler: BySize::new(),
            disks: Vec::new(),
            gravity: Gravity::NONE,
            seed: 0,
            start_time: 0.0,
        }
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> SimulationBuilder<R, B, S> {
    /// Sets the disks, as they are at the start time.
    pub fn disks(mut self, disks: impl IntoIterator<Item = Disk>) -> Self {
        self.disks = disks.into_iter().collect();
        self
    }

    /// Sets gravity; 0 unless given.
    ///
    /// A number stands for gravity that points down, or up if the number is negative. A vector stands for the
    /// acceleration itself, and [`Gravity::tilted`] gives the gravity on a slope.
    pub fn gravity(mut self, gravity: impl Into<Gravity>) -> Self {
        self.gravity = gravity.into();
        self
    }

    /// Sets the seed of the stochastic walls, such as thermal walls; 0 unless given.
    ///
    /// The random numbers of a collision follow from the seed, the disk's [id](Disk::id), and the time and
    /// the number of the disk's collision. Repeats of a run need different seeds, like their initial states:
    /// with the same random numbers at the walls, they are not independent. A repeat may have one seed for
    /// everything, since its parts draw from separate [streams](crate::random).
    pub const fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the time at which the run starts; 0 unless given.
    pub const fn starting_at(mut self, time: f64) -> Self {
        self.start_time = time;
        self
    }

    /// Sets another scheduler.
    ///
    /// The trajectory is the same, bit for bit.
    pub fn scheduler<T: EventScheduler>(self, scheduler: T) -> SimulationBuilder<R, B, T> {
        let Self { rule, boundary, scheduler: _, disks, gravity, seed, start_time } = self;
        SimulationBuilder { rule, boundary, scheduler, disks, gravity, seed, start_time }
    }

    /// Builds the simulation.
    ///
    /// # Errors
    /// The build fails if
    /// - gravity or the start time is not finite, or gravity is above 1e60 in magnitude;
    /// - a disk moves at a speed below 1e-100 that is not 0, or the disks are so fast that times as late as
    ///   the start are too coarse for them;
    /// - there are too many disks or walls, two disks have the same id, or there are no ids left;
    /// - the domain is not finite (only its top may be infinite), or is too small for the disks;
    /// - a disk is so far from the origin that positions there are too coarse for its radius;
    /// - a disk is outside, overlaps a wall or another disk, or just fills a hollow of a wall; the error
    ///   names the disk.
    pub fn build(self) -> Result<Simulation<R, B, S>, BuildError> {
        let gravity = self.gravity.checked()?;
        finite("start time", self.start_time)?;
        countable(self.disks.len())?;
        check_speeds(self.disks.iter().map(Disk::velocity))?;
        Identities::default().check_room(&self.disks)?;
        let mut boundary = self.boundary;
        boundary.set_time_origin(self.start_time);
        let (wall_count, cells) = fit(&boundary, &self.disks, 0.0)?;
        let bodies = Bodies::new(&self.disks, gravity);
        let clock = Clock::new(self.start_time, bodies.epoch_length());
        if !self.disks.is_empty() {
            check_epoch(&clock, 0.0)?;
        }
        let energy = bodies.energy(0.0, &boundary.domain())[0];
        let ledger = Ledger::new(self.start_time, energy);
        let mut simulation = Simulation {
            parts: Parts { rule: self.rule, boundary, scheduler: self.scheduler },
            engine: Engine::new(wall_count, bodies, cells, clock, self.seed, ledger).into(),
        };
        simulation.predict_all();
        Ok(simulation)
    }
}

/// Returns the number of walls and the neighbor cells, if the disks fit into the boundary at this time
/// offset.
pub(super) fn fit(
    boundary: &dyn Boundary,
    disks: &[Disk],
    offset: f64,
) -> Result<(usize, Cells), BuildError> {
    let wall_count = count_walls(boundary)?;
    check_ids(disks)?;
    check_inside(boundary, disks, offset)?;
    let cells = cells_around(boundary, disks)?;
    check_overlaps(boundary, disks, &cells)?;
    Ok((wall_count, cells))
}

/// Checks that no disk is so slow that the square of its speed vanishes.
pub(super) fn check_speeds(velocities: impl IntoIterator<Item = DVec2>) -> Result<(), ParameterError> {
    let mut speeds = velocities.into_iter().map(|velocity| velocity.abs().max_element());
    let slow = speeds.find(|&speed| speed > 0.0 && speed < SLOWEST);
    slow.map_or(Ok(()), |speed| Err(ParameterError::new("speed of a disk", "0 or at least 1e-100", speed)))
}

/// Checks that no two disks have the same id.
fn check_ids(disks: &[Disk]) -> Result<(), BuildError> {
    let numbered = disks.iter().enumerate().filter(|(_, disk)| disk.id() != 0);
    let mut ids: Vec<(u64, usize)> = numbered.map(|(index, disk)| (disk.id(), index)).collect();
    ids.sort_unstable();
    let twice = ids.windows(2).find(|pair| pair[0].0 == pair[1].0);
    twice
        .map_or(Ok(()), |pair| Err(BuildError::SameId { id: pair[0].0, first: pair[0].1, second: pair[1].1 }))
}

/// Checks that times at this offset are not too coarse, so that time cannot stand still.
pub(super) fn check_epoch(clock: &Clock, offset: f64) -> Result<(), BuildError> {
    let Some(spacing) = clock.coarseness(offset) else { return Ok(()) };
    Err(BuildError::StartTime { start: clock.origin + offset, spacing, epoch: clock.epoch_length })
}

/// Returns the number of walls, or an error if there are too many for the engine.
pub(super) fn count_walls(boundary: &dyn Boundary) -> Result<usize, BuildError> {
    let count = boundary.wall_count();
    accept(count <= MOST_WALLS, "number of walls", "at most 2^16", count as f64)?;
    Ok(count)
}

/// Returns neighbor cells that suit these disks.
pub(super) fn cells_around(boundary: &dyn Boundary, disks: &[Disk]) -> Result<Cells, BuildError> {
    let diameter = 2.0 * disks.iter().map(Disk::radius).fold(0.0, f64::max);
    let domain = boundary.domain();
    let is_bounded = domain.width().is_finite() && domain.bottom.is_finite();
    if !is_bounded || (domain.periodic_ends && !domain.height().is_finite()) {
        return Err(BuildError::Domain { domain });
    }
    // Walls that pass through each other leave no room for disks.
    let interior = boundary.interior();
    if !(interior.width() > 0.0 && interior.height() > 0.0) {
        let (width, height) = (interior.width(), interior.height());
        return Err(BuildError::DomainTooSmall { width, height, diameter });
    }
    let places = disks.iter().map(|disk| (disk.position(), disk.radius()));
    Cells::new(boundary, CellSize::Medium, places, None).ok_or_else(|| too_small(&domain, diameter))
}

/// Returns the error of a domain without room for a disk of this diameter.
pub(super) fn too_small(domain: &Domain, diameter: f64) -> BuildError {
    BuildError::DomainTooSmall { width: domain.width(), height: domain.height(), diameter }
}

/// Checks that all disks are inside the domain and none overlaps a wall at this time offset.
fn check_inside(boundary: &dyn Boundary, disks: &[Disk], offset: f64) -> Result<(), BuildError> {
    let domain = boundary.domain();
    for (disk, state) in disks.iter().enumerate() {
        let (position, radius) = (state.position(), state.radius());
        let spacing = f64::EPSILON * position.abs().max_element();
        accept(spacing <= COARSEST * radius, "spacing of positions", "at most 1e-3 of a radius", spacing)?;
        // A disk that is about to pass a periodic side may be beyond that side by rounding.
        if !domain.contains(position, TOUCHING * radius) {
            return Err(BuildError::Outside { disk, x: position.x, y: position.y, domain });
        }
        if let Some(Overlap { with: wall, depth }) = boundary.overlap(&Probe::of(state, offset))
            && (depth.is_nan() || depth > TOUCHING * radius)
        {
            let wall = WallView::of(boundary, wall, offset).to_string();
            return Err(BuildError::OverlapsWall { disk, x: position.x, y: position.y, wall, depth });
        }
        if let Some(wall) = boundary.tight_fit(radius) {
            let wall = WallView::of(boundary, wall, offset).to_string();
            return Err(BuildError::TightFit { disk, radius, wall });
        }
    }
    Ok(())
}

/// Checks that no two disks overlap.
fn check_overlaps(boundary: &dyn Boundary, disks: &[Disk], cells: &Cells) -> Result<(), BuildError> {
    let domain = boundary.domain();
    let mut found = vec![0; cells.room()];
    for first in 0..disks.len() {
        let count = cells.around(first, &mut found);
        // A large disk does not search the cells inside itself, so a small disk in these cells must find the
        // large disk.
        let is_asked = |second: usize| second < first || (second > first && cells.is_large(second));
        for &second in found[..count].iter().filter(|&&second| is_asked(second as usize)) {
            let (a, b) = (&disks[second as usize], &disks[first]);
            let contact = a.radius() + b.radius();
            let depth = contact - domain.separation(a.position(), b.position()).length();
            if depth > TOUCHING * contact {
                let (second, first) = (first.max(second as usize), first.min(second as usize));
                let positions = [first, second].map(|disk| disks[disk].position());
                return Err(BuildError::Overlap { first, second, positions, depth });
            }
        }
    }
    Ok(())
}
