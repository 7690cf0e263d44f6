//! A custom wall motion: a base that rests between its kicks.
//!
//! ```text
//! cargo run --release -p granular-edmd --example own_wall
//! ```
//!
//! It takes two seconds. You learn what a wall motion returns (position, velocity, bounds on its
//! acceleration), and how to check it.

use granular_edmd::prelude::*;
use granular_edmd::wall::{AccelerationBounds, WallState, laws};

/// A base that hops: half of the time it flies on a parabola of height `height`, then it rests.
#[derive(Debug, Clone, Copy)]
struct Hopping {
    height: f64,
    period: f64,
}

impl Hopping {
    /// Returns the time since the period began, the phase at which it began, and the duration of the hop.
    fn moment(&self, phase: f64) -> (f64, f64, f64) {
        let begin = (phase / self.period).floor() * self.period;
        (phase - begin, begin, 0.5 * self.period)
    }
}

impl WallMotion for Hopping {
    fn state(&self, phase: f64) -> WallState {
        let (time, _, hop) = self.moment(phase);
        if time >= hop {
            return WallState::new(0.0, 0.0);
        }
        let share = time / hop;
        WallState::new(
            4.0 * self.height * share * (1.0 - share),
            4.0 * self.height * (1.0 - 2.0 * share) / hop,
        )
    }

    // The engine finds touches exactly where acceleration is constant, so each piece names its end.
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let (time, begin, hop) = self.moment(phase);
        if time >= hop {
            return AccelerationBounds::new(begin + self.period, 0.0, 0.0);
        }
        let acceleration = -8.0 * self.height / (hop * hop);
        AccelerationBounds::new(begin + hop, acceleration, acceleration)
    }

    fn reach(&self) -> (f64, f64) {
        (0.0, self.height)
    }

    fn period(&self) -> Option<f64> {
        Some(self.period)
    }
}

fn main() -> anyhow::Result<()> {
    println!("period  height of the center of mass");
    for period in [0.5, 1.0, 2.0, 4.0] {
        let base = Hopping { height: 0.2, period };
        // The check compares position, velocity and acceleration on all pieces of 20 periods.
        laws::check(&base, 0.0, 20.0 * period)?;
        let container = Container::open(20.0)?.with_motion(Wall::Floor, base)?;
        let disks = initial::scattered(&container, 100, 0.5, 20.0, 1)?;
        // Grains that come to rest on the base leave it with a speed of at least 0.1; otherwise, the run
        // would stall.
        let rule = LeastRebound::new(Frictional::from_inelasticity(0.05, 0.05, 0.1)?, 0.1)?;
        let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(1.0).build()?;
        simulation.run_until(50.0, &mut ())?;
        let mut series = Series::new(CenterOfMass, SampleTimes::every(0.37)?);
        simulation.run_until(150.0, &mut series)?;
        println!("{period:6}  {}", series.mean(|center| center.y)?);
    }
    Ok(())
}
