//! A scheduler that names disks that do not exist, in answer to a question that is only a hint.

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::scheduler::laws::check;
use granular_edmd::scheduler::{BucketQueue, EventScheduler};
use granular_edmd::{Simulation, initial};

/// A scheduler that names disks that do not exist, besides the right ones.
#[derive(Default)]
struct Ghosts(BucketQueue);

impl EventScheduler for Ghosts {
    fn reset(&mut self, due: &[f64]) {
        self.0.reset(due);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.0.set(disk, due);
    }

    fn earliest(&self) -> (usize, f64) {
        self.0.earliest()
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        self.0.upcoming(disks);
        disks.extend([usize::MAX, 1 << 40, 1 << 32, u32::MAX as usize, 40_000]);
    }
}

/// The engine asks for upcoming disks from 30 000 on.
#[test]
fn upcoming_disks_that_do_not_exist_are_ignored_by_the_engine() {
    assert_eq!(check(Ghosts::default), Ok(()), "it is a hint, and no law is broken");
    let container = Container::closed(400.0, 400.0).unwrap();
    let disks = initial::lattice(&container, 40_000, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let builder = || Simulation::builder(Elastic, container.clone()).disks(disks.clone());
    let mut misled = builder().scheduler(Ghosts::default()).build().unwrap();
    let mut plain = builder().build().unwrap();
    misled.run_until(0.2, &mut ()).unwrap();
    plain.run_until(0.2, &mut ()).unwrap();
    assert!(plain.counters().disk_collisions > 1000, "{:?}", plain.counters());
    assert_eq!(misled.disks(), plain.disks());
}
