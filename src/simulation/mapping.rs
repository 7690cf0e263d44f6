//! Changes of disks between runs.

use super::builder::{check_epoch, check_speeds, fit};
use super::state::Clock;
use super::{BuildError, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::scheduler::EventScheduler;
use crate::{Disk, ParameterError};

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
        let fitted =
            (!all_stay).then(|| fit(&self.parts.boundary, disks, self.engine.clock.now)).transpose()?;
        let mut bodies = self.engine.bodies.clone();
        bodies.replace(disks, self.engine.clock.now);
        check_epoch(
            &Clock { epoch_length: bodies.epoch_length(), ..self.engine.clock },
            self.engine.clock.now,
        )?;
        // The position of a fast disk at a distant epoch would lack digits, so the epoch moves first.
        self.shift_epoch(self.engine.clock.exact_offset());
        self.engine.bodies.replace(disks, self.engine.clock.now);
        if let Some((wall_count, cells)) = fitted {
            (self.engine.wall_count, self.engine.cells) = (wall_count, cells);
        }
        self.begin_anew();
        Ok(())
    }
}
