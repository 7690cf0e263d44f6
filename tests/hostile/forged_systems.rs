//! Runs of all kinds whose checkpoints are forged.

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::{CollisionRule, ContactDuration, Elastic, Frictional, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::scheduler::LinearScan;
use granular_edmd::simulation::{Checkpoint, CheckpointError};
use granular_edmd::wall::{BiParabolic, Sinusoidal};
use granular_edmd::{Disk, Simulation, initial};

type Rule = Box<dyn CollisionRule>;
pub(crate) type Run = Simulation<Rule, Container, LinearScan>;

/// A run that is forged, some way in.
pub(crate) struct System {
    pub(crate) name: &'static str,
    rule: fn() -> Rule,
    container: fn() -> Container,
    disks: fn(&Container) -> Vec<Disk>,
    gravity: f64,
    end: f64,
}

pub(crate) const SYSTEMS: [System; 8] = [
    System {
        name: "thermal floor, mixed disks",
        rule: dissipative,
        container: || box_of(6.0).with_temperature(Wall::Floor, Thermal::new(1.0).unwrap()).unwrap(),
        disks: mixed,
        gravity: 0.1,
        end: 3.0,
    },
    System {
        name: "periodic sides",
        rule: dissipative,
        container: || box_of(7.0).with_periodic_sides().unwrap(),
        disks: |container| gas(container, 5),
        gravity: 0.0,
        end: 3.0,
    },
    System {
        name: "open top",
        rule: dissipative,
        container: || Container::open(5.0).unwrap(),
        disks: |container| gas(container, 4),
        gravity: 1.0,
        end: 3.0,
    },
    System {
        name: "fast sinusoidal floor and lid",
        rule: dissipative,
        container: || {
            let fast = Sinusoidal::new(0.1, 50.0).unwrap();
            let box_of = box_of(5.0).with_motion(Wall::Floor, fast).unwrap();
            box_of.with_motion(Wall::Lid, Sinusoidal::new(0.05, 77.0).unwrap()).unwrap()
        },
        disks: |container| gas(container, 4),
        gravity: 0.3,
        end: 1.0,
    },
    System {
        name: "closed box without gravity",
        rule: || Box::new(Elastic),
        container: || box_of(5.0),
        disks: |container| gas(container, 4),
        gravity: 0.0,
        end: 3.0,
    },
    System {
        name: "one disk alone",
        rule: || Box::new(Elastic),
        container: || box_of(5.0),
        disks: |container| gas(container, 1),
        gravity: 0.5,
        end: 10.0,
    },
    System {
        name: "collapse",
        rule: || Box::new(Smooth::from_inelasticity(0.4).unwrap()),
        container: || box_of(10.0),
        disks: |container| gas(container, 20),
        gravity: 0.0,
        end: 30.0,
    },
    System {
        name: "vibrated floor",
        rule: dissipative,
        container: || box_of(5.0).with_motion(Wall::Floor, BiParabolic::new(0.1, 3.0).unwrap()).unwrap(),
        disks: |container| gas(container, 4),
        gravity: 0.1,
        end: 3.0,
    },
];

fn dissipative() -> Rule {
    Box::new(ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2).unwrap(), 1e-3).unwrap())
}

fn box_of(width: f64) -> Container {
    Container::closed(width, 4.0).unwrap()
}

fn gas(container: &Container, count: usize) -> Vec<Disk> {
    let disks = initial::lattice(container, count, 0.5).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap()
}

fn mixed(container: &Container) -> Vec<Disk> {
    let disk = |radius: f64| {
        Disk::new(DVec2::ZERO, radius).and_then(|disk| disk.with_mass(4.0 * radius * radius)).unwrap()
    };
    let disks = [0.5, 0.3, 0.7, 0.05, 0.2].map(disk).to_vec();
    let disks = initial::placed_at_random(container, disks, 4.0, 5).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap()
}

impl System {
    /// Returns the state some way into the run. A run that stalls before also has a state.
    pub(crate) fn checkpoint(&self) -> Checkpoint {
        let container = (self.container)();
        let disks = (self.disks)(&container);
        let builder = Simulation::builder((self.rule)(), container).disks(disks).gravity(self.gravity);
        let mut run = builder.build().unwrap();
        let _ = run.run_until(self.end, &mut ());
        run.checkpoint()
    }

    pub(crate) fn resume(&self, checkpoint: &Checkpoint) -> Result<Run, CheckpointError> {
        let resumption = Simulation::resume(checkpoint, (self.rule)(), (self.container)());
        resumption.with_another_rule().scheduler(LinearScan::new()).build()
    }

    /// The run within other walls.
    pub(crate) fn resume_elsewhere(&self, checkpoint: &Checkpoint) -> Result<Run, CheckpointError> {
        let walls = Container::closed(8.0, 9.0).unwrap();
        let walls = walls.with_motion(Wall::Lid, Sinusoidal::new(0.1, 3.0).unwrap()).unwrap();
        let resumption = Simulation::resume(checkpoint, (self.rule)(), walls).with_another_boundary();
        resumption.with_another_rule().scheduler(LinearScan::new()).build()
    }
}
