//! Walls that pass the check of the container and go wrong later. No disk falls through the floor unnoticed.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::Smooth;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{RunEnd, RunError};
use granular_edmd::wall::{AccelerationBounds, WallMotion, WallState, laws};
use granular_edmd::{Disk, Simulation};

/// Phases in which something is wrong. The container looks at none of them.
const BAD: std::ops::Range<f64> = 20.0..30.0;

/// A floor at rest that claims a reach of 0.1.
#[derive(Debug, Clone, Copy)]
enum Late {
    Displacement(f64),
    Velocity(f64),
    Bound(f64),
    TinyPieces,
}

impl WallMotion for Late {
    fn state(&self, phase: f64) -> WallState {
        match *self {
            Self::Displacement(value) if BAD.contains(&phase) => WallState::new(value, 0.0),
            Self::Velocity(value) if BAD.contains(&phase) => WallState::new(0.0, value),
            _ => WallState::new(0.0, 0.0),
        }
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        // The pieces are so short that the check, which follows a few of them, does not come to the bad ones.
        let until = phase + 1.0;
        match *self {
            Self::Bound(value) if BAD.contains(&phase) => AccelerationBounds::new(until, -value, value),
            Self::TinyPieces if BAD.contains(&phase) => AccelerationBounds::new(phase.next_up(), -1.0, 1.0),
            _ => AccelerationBounds::new(until, -1.0, 1.0),
        }
    }
    fn reach(&self) -> (f64, f64) {
        (-0.1, 0.1)
    }
}

/// Runs three disks that bounce on the floor until time 40. Returns how the run ended, and the least height.
fn outcome(motion: Late) -> (Result<RunEnd, RunError>, f64) {
    let container = Container::closed(8.0, 9.0).unwrap().with_motion(Wall::Floor, motion).unwrap();
    let disks = [1.0, 3.0, 6.0].map(|x| Disk::new(DVec2::new(x, 2.0), 0.5).unwrap());
    let rule = Smooth::from_inelasticity(0.0).unwrap();
    let mut run = Simulation::builder(rule, container).disks(disks).gravity(1.0).build().unwrap();
    let outcome = run.run_until(40.0, &mut ());
    let lowest = run.disks().iter().map(|disk| disk.position().y).fold(f64::INFINITY, f64::min);
    (outcome, lowest)
}

#[test]
fn walls_that_go_wrong_late_end_the_run() {
    let numbers = [f64::NAN, f64::INFINITY].map(|value| {
        [Late::Displacement(value), Late::Velocity(value), Late::Bound(value), Late::Displacement(-value)]
    });
    for motion in numbers.concat().into_iter().chain([Late::Bound(1e300), Late::TinyPieces]) {
        // A wall that cannot be followed counts as anywhere in its reach. Disks turn back, and the run may go
        // on.
        let may_go_on = matches!(motion, Late::Bound(1e300) | Late::TinyPieces);
        let (outcome, lowest) = outcome(motion);
        assert!(outcome.is_err() || may_go_on, "{motion:?}: {outcome:?}");
        // Bounds that are too large break no law.
        let is_lawful = matches!(motion, Late::Bound(1e300));
        assert_eq!(laws::check(&motion, 0.0, 40.0).is_ok(), is_lawful, "{motion:?}");
        assert!(lowest > 0.39, "{motion:?}: {lowest}");
    }
}
