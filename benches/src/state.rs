//! The paper's box with a thousand disks, or a wider box with proportionally more disks.

use std::error::Error;
use std::fmt;

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::scheduler::{EventScheduler, TournamentTree};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};

/// The result of a measurement, with any error that can occur before or during it.
pub type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// Number of disks in a box of the paper's width.
pub const DISKS: usize = 1000;
pub const WIDTH: f64 = 60.0;
pub const HEIGHT: f64 = 150.0;
pub const AMPLITUDE: f64 = 0.1;
pub const ANGULAR_FREQUENCY: f64 = 10.0;

/// Contact duration, short enough to change nothing but the collapse.
pub const CONTACT_DURATION: f64 = 1e-5;

/// Time of one oscillation of the base.
pub const OSCILLATION: f64 = std::f64::consts::TAU / ANGULAR_FREQUENCY;

pub type Run<S = TournamentTree> = Simulation<ContactDuration<Frictional>, Container, S>;

/// The parameters that decide how dense the gas becomes.
#[derive(Debug, Clone, Copy)]
pub struct State {
    pub gravity: f64,
    pub friction: f64,
    pub inelasticity: f64,
}

/// A gas that fills the box. Most events are passages between cells.
pub const DILUTE: State = State { gravity: 0.015_625, friction: 0.03, inelasticity: 0.0 };

/// A fluid that is a dozen diameters high. Most events are collisions.
pub const DENSE: State = State { gravity: 0.015_625, friction: 0.1, inelasticity: 0.05 };

impl State {
    /// Puts these disks into a box that is `boxes` times as wide as the paper's.
    pub fn run<S: EventScheduler>(&self, disks: Vec<Disk>, boxes: usize, scheduler: S) -> Outcome<Run<S>> {
        let rule = Frictional::from_inelasticity(self.inelasticity, self.inelasticity, self.friction)?;
        let rule = ContactDuration::new(rule, CONTACT_DURATION)?;
        let run = Simulation::builder(rule, container(boxes)?).disks(disks).gravity(self.gravity);
        Ok(run.scheduler(scheduler).build()?)
    }

    /// Returns a thousand disks in the paper's box, which have forgotten their lattice after `oscillations`
    /// oscillations.
    pub fn settled(&self, seed: u64, oscillations: u32) -> Outcome<Run> {
        let disks = initial::lattice(&container(1)?, DISKS, 0.5)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, seed)?;
        let mut run = self.run(disks, 1, TournamentTree::new())?;
        oscillate(&mut run, oscillations)?;
        Ok(run)
    }
}

fn container(boxes: usize) -> Outcome<Container> {
    let base = BiParabolic::new(AMPLITUDE, ANGULAR_FREQUENCY)?;
    Ok(Container::closed(WIDTH * boxes as f64, HEIGHT)?.with_motion(Wall::Floor, base)?)
}

/// Continues the run for `oscillations` oscillations of the base.
pub fn oscillate<S: EventScheduler>(run: &mut Run<S>, oscillations: u32) -> Outcome<()> {
    run.run_until(run.time() + f64::from(oscillations) * OSCILLATION, &mut ())?;
    Ok(())
}

impl fmt::Display for State {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "g = {}, κ = {}, q = {}", self.gravity, self.friction, self.inelasticity)
    }
}
