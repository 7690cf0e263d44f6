//! Systems of all kinds: few disks of any size, mass and moment of inertia, any gravity, any start time.

use granular_edmd::glam::DVec2;
use granular_edmd::simulation::SimulationBuilder;
use granular_edmd::{Disk, Gravity, Simulation, initial};
use proptest::prelude::*;

use granular_edmd::boundary::Container;

use crate::laws::{Law, Rule, law};
use crate::walls::{Walls, walls};
use support::cases::decades;
use support::schedulers::Scheduler;

pub(crate) type Run = Simulation<Rule, Container, Scheduler>;

#[derive(Debug, Clone)]
pub(crate) struct System {
    pub(crate) walls: Walls,
    pub(crate) law: Law,
    pub(crate) gravity: Gravity,
    start: f64,
    seed: u64,
    disks: Vec<Disk>,
}

impl System {
    pub(crate) fn run(&self, scheduler: Scheduler) -> Run {
        self.builder().scheduler(scheduler).build().unwrap()
    }

    fn builder(&self) -> SimulationBuilder<Rule, Container> {
        Simulation::builder(self.law.rule(), self.walls.container())
            .disks(self.disks.iter().copied())
            .gravity(self.gravity)
            .seed(self.seed)
            .starting_at(self.start)
    }
}

/// A disk somewhere, with its surface at some speed.
fn disk() -> impl Strategy<Value = Disk> {
    (0.05..1.0f64, decades(-2.0, 2.0), 0.05..=1.0f64, -3.0..3.0f64).prop_map(
        |(radius, mass, inertia, surface)| {
            Disk::new(DVec2::ZERO, radius)
                .and_then(|disk| disk.with_mass(mass)?.with_inertia_factor(inertia))
                .and_then(|disk| disk.with_angular_velocity(surface / radius))
                .unwrap()
        },
    )
}

/// Unequal disks, or equal ones.
fn disks() -> impl Strategy<Value = Vec<Disk>> {
    prop_oneof![
        2 => prop::collection::vec(disk(), 0..12),
        1 => (disk(), 0..12usize).prop_map(|(disk, count)| vec![disk; count]),
    ]
}

pub(crate) fn gravity() -> impl Strategy<Value = Gravity> {
    let down = prop_oneof![Just(0.0), Just(0.05), Just(-0.05), Just(1.0), Just(-1.0), -0.5..0.5f64];
    let any = (-0.5..0.5f64, -0.5..0.5f64).prop_map(|(x, y)| DVec2::new(x, y).into());
    prop_oneof![3 => down.prop_map(Gravity::from), 1 => any]
}

pub(crate) fn system() -> impl Strategy<Value = System> {
    let start = prop_oneof![4 => Just(0.0), 1 => Just(-100.3), 1 => Just(1e7), 1 => Just(1e12)];
    let temperature = prop_oneof![4 => Just(1.0), 1 => Just(0.0), 1 => decades(-6.0, 3.0)];
    (walls(), law(), disks(), gravity(), start, temperature, any::<u64>()).prop_filter_map(
        "the disks must find room",
        |(walls, law, disks, gravity, start, temperature, seed)| {
            let disks = initial::scattered_mix(&walls.container(), disks, walls.height, seed).ok()?;
            let disks = initial::with_maxwellian_velocities(disks, temperature, seed).ok()?;
            Some(System { walls, law, gravity, start, seed, disks })
        },
    )
}
