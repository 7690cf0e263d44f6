//! Changes of disks between runs: insertion, removal, and maps.

use std::ops::Range;

use super::builder::{cells_around, check_epoch, check_speeds, fit};
use super::cells::Cells;
use super::engine::Engine;
use super::lookahead::Lookahead;
use super::state::{Bodies, Clock};
use super::{BuildError, Simulation};
use crate::boundary::{Boundary, Domain};
use crate::collision::CollisionRule;
use crate::disk::countable;
use crate::scheduler::EventScheduler;
use crate::{Disk, ParameterError};

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Puts disks into the simulation at the present time, and returns their indices.
    ///
    /// The new disks come after all others, in the order given.
    ///
    /// All events are predicted anew. The run then has the same bits under every scheduler, and even if it is
    /// resumed from a checkpoint taken before or after. The counters keep counting. The new disks have
    /// collided with nothing yet, and may be of any size and kind. A disk that was removed before keeps its
    /// [id](Disk::id); a disk without an id gets a new one.
    ///
    /// # Errors
    /// If a disk is outside, overlaps a wall or overlaps another disk, or has the id of another; the error
    /// names its index. The insertion also fails if there would be too many disks, the domain is too small
    /// for a disk, or a disk is so fast that times as late as the present are too coarse. The simulation then
    /// stays unchanged.
    ///
    /// ```
    /// use granular_edmd::boundary::Container;
    /// use granular_edmd::collision::Elastic;
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::{Disk, Simulation};
    ///
    /// let disk = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5);
    /// let container = Container::open(4.0)?;
    /// let mut run = Simulation::builder(Elastic, container).disks([disk(1.0)?]).gravity(1.0).build()?;
    /// run.run_until(0.5, &mut ())?;
    /// assert_eq!(run.insert([disk(3.0)?, disk(5.0)?])?, 1..3);
    /// assert!(run.insert([disk(3.2)?]).is_err(), "it overlaps another one");
    /// let removed = run.remove(|_, disk| disk.position().y > 4.0)?;
    /// assert_eq!((removed.len(), run.len()), (1, 2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn insert(&mut self, disks: impl IntoIterator<Item = Disk>) -> Result<Range<usize>, BuildError> {
        let new: Vec<Disk> = disks.into_iter().collect();
        let indices = self.len()..self.len() + new.len();
        countable(indices.end)?;
        check_speeds(new.iter().map(Disk::velocity))?;
        self.engine.bodies.identities.check_room(&new)?;
        let mut all = self.disks();
        all.extend_from_slice(&new);
        let (wall_count, cells) = fit(&self.parts.boundary, &all, self.engine.clock.now)?;
        self.change((wall_count, cells), |bodies, now| bodies.insert(&new, now))?;
        Ok(indices)
    }

    /// Removes the disks that `chosen` selects by their index and state, and returns them in the same order.
    ///
    /// The other disks keep their order: the index of each becomes smaller by the number of disks removed
    /// before it. The disks keep their [ids](Disk::id). As after [`insert`](Self::insert), the run then has
    /// the same bits under every scheduler.
    ///
    /// # Errors
    /// If the boundary's domain cannot hold the other disks any more, which happens only if the boundary
    /// breaks its contract. The simulation then stays unchanged.
    pub fn remove(&mut self, mut chosen: impl FnMut(usize, &Disk) -> bool) -> Result<Vec<Disk>, BuildError> {
        let all = self.disks();
        let leaves: Vec<bool> = all.iter().enumerate().map(|(index, disk)| chosen(index, disk)).collect();
        let (mut removed, mut rest) = (Vec::new(), Vec::new());
        for (disk, leaves) in all.into_iter().zip(&leaves) {
            if *leaves { removed.push(disk) } else { rest.push(disk) }
        }
        if removed.is_empty() {
            return Ok(removed);
        }
        let cells = cells_around(&self.parts.boundary, &rest)?;
        self.change((self.engine.wall_count, cells), |bodies, _| bodies.remove(&leaves))?;
        Ok(removed)
    }

    /// Changes the bodies between two runs, and predicts all events anew in these cells.
    fn change(
        &mut self,
        fitted: (usize, Cells),
        change: impl Fn(&mut Bodies, f64),
    ) -> Result<(), BuildError> {
        let now = self.engine.clock.now;
        let mut bodies = self.engine.bodies.clone();
        change(&mut bodies, now);
        check_epoch(&Clock { epoch_length: bodies.epoch_length(), ..self.engine.clock }, now)?;
        // The position of a fast disk at a distant epoch would lack digits, so the epoch moves first.
        self.shift_epoch(self.engine.clock.exact_offset());
        self.engine.ledger.count(self.time(), self.len());
        change(&mut self.engine.bodies, self.engine.clock.now);
        (self.engine.wall_count, self.engine.cells) = fitted;
        self.engine.lookahead = Lookahead::default();
        self.engine.balance_anew(&self.parts.boundary.domain());
        self.engine.clock.epoch_length = self.engine.bodies.epoch_length();
        self.predict_all();
        Ok(())
    }
}

impl Engine {
    /// Begins a new balance of the energy, after a change that is not part of a run.
    pub(super) fn balance_anew(&mut self, domain: &Domain) {
        let [energy, _] = self.bodies.energy(self.clock.now, domain);
        self.ledger.balance_anew(energy - self.counters.energy_of_rebounds);
        self.stopped = None;
        self.energies_of_walls.clear();
    }
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Replaces each disk by the result of `change` for its index and its present state.
    ///
    /// The order, the [ids](Disk::id) and the times of the last collisions are kept. All events are predicted
    /// anew. As after [`insert`](Self::insert), the run then has the same bits under every scheduler.
    ///
    /// # Errors
    /// If `change` fails, a disk does not fit at its new position, with its new radius or as its new kind, or
    /// a disk becomes so fast that times as late as the present are too coarse. The simulation then stays
    /// unchanged.
    ///
    /// ```
    /// # use granular_edmd::{Simulation, boundary::Container, collision::Elastic, initial};
    /// # let container = Container::closed(20.0, 20.0)?;
    /// # let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 1.0, 1)?;
    /// # let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    /// use granular_edmd::observable::Energies;
    /// let before = run.measure(&Energies).translational;
    /// run.map_disks(|_, disk| disk.with_velocity(2.0 * disk.velocity()))?;
    /// assert!((run.measure(&Energies).translational / before - 4.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn map_disks(
        &mut self,
        mut change: impl FnMut(usize, Disk) -> Result<Disk, ParameterError>,
    ) -> Result<(), BuildError> {
        let disks = self.disks().into_iter().enumerate().map(|(index, disk)| change(index, disk));
        self.replace_disks(&disks.collect::<Result<Vec<_>, _>>()?)
    }

    /// Replaces all disks by the given ones.
    pub(super) fn replace_disks(&mut self, disks: &[Disk]) -> Result<(), BuildError> {
        check_speeds(disks.iter().map(Disk::velocity))?;
        let stay = |(index, disk): (usize, &Disk)| {
            // Some walls exist only for some kinds of disks.
            disk.position() == self.engine.bodies.position(index, self.engine.clock.now)
                && disk.radius() == self.engine.bodies.radius(index)
                && disk.kind() == self.engine.bodies.material(index).kind
        };
        let all_stay = disks.iter().enumerate().all(stay);
        let fitted = if all_stay {
            (self.engine.wall_count, self.engine.cells.clone())
        } else {
            fit(&self.parts.boundary, disks, self.engine.clock.now)?
        };
        self.change(fitted, |bodies, now| bodies.replace(disks, now))
    }
}
