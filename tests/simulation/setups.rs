//! Set-ups of all kinds, from a few random numbers.

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Observer};
use granular_edmd::scheduler::EventScheduler;
use granular_edmd::simulation::SimulationBuilder;
use granular_edmd::wall::{BiParabolic, Sinusoidal};
use granular_edmd::{Disk, Gravity, Simulation, initial};
use proptest::prelude::*;

pub(crate) use support::cases::config;

pub(crate) type Rule = ContactDuration<Frictional>;

#[derive(Debug, Clone, Copy)]
pub(crate) enum Base {
    Fixed,
    BiParabolic,
    Sinusoidal,
    Thermal,
}

#[derive(Debug, Clone)]
pub(crate) struct Setup {
    pub(crate) base: Base,
    pub(crate) periodic: bool,
    pub(crate) open: bool,
    pub(crate) polydisperse: bool,
    pub(crate) gravity: Gravity,
    pub(crate) inelasticity: f64,
    pub(crate) friction: f64,
    pub(crate) count: usize,
    pub(crate) start: f64,
    pub(crate) seed: u64,
}

pub(crate) fn setup() -> impl Strategy<Value = Setup> {
    let base =
        prop_oneof![Just(Base::Fixed), Just(Base::BiParabolic), Just(Base::Sinusoidal), Just(Base::Thermal)];
    let gravity = prop_oneof![
        Just(0.0.into()),
        Just(0.05.into()),
        Just((-0.05).into()),
        Just(1.0.into()),
        Just(Gravity::tilted(0.3, 0.7).unwrap())
    ];
    let flags = any::<[bool; 3]>();
    let rule = (0.0..0.1f64, 0.0..0.5f64);
    let start = prop_oneof![3 => Just(0.0), 1 => Just(-100.3), 1 => Just(1e7)];
    (base, flags, gravity, rule, 0..60usize, start, any::<u64>()).prop_map(
        |(base, [periodic, open, polydisperse], gravity, (inelasticity, friction), count, start, seed)| {
            Setup {
                base,
                periodic,
                // Disks that fall upward need a lid.
                open: open && gravity.downward() >= 0.0,
                polydisperse,
                gravity,
                inelasticity,
                friction,
                count,
                start,
                seed,
            }
        },
    )
}

impl Setup {
    pub(crate) fn boundary(&self) -> Container {
        let container =
            if self.open { Container::open(14.0) } else { Container::closed(14.0, 20.0) }.unwrap();
        let container = if self.periodic { container.with_periodic_sides().unwrap() } else { container };
        match self.base {
            Base::Fixed => Ok(container),
            Base::BiParabolic => container.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0).unwrap()),
            Base::Sinusoidal => container.with_motion(Wall::Floor, Sinusoidal::new(0.1, 10.0).unwrap()),
            Base::Thermal => container.with_temperature(Wall::Floor, Thermal::new(1.0).unwrap()),
        }
        .unwrap()
    }

    pub(crate) fn disks(&self) -> Vec<Disk> {
        let radius = |k: usize| if self.polydisperse { [0.5, 0.25, 0.7, 0.1][k % 4] } else { 0.5 };
        let disk = |k| {
            Disk::new(DVec2::ZERO, radius(k)).and_then(|d| d.with_mass(4.0 * radius(k) * radius(k))).unwrap()
        };
        let disks = (0..self.count).map(disk).collect();
        let disks = initial::scattered_mix(&self.boundary(), disks, 20.0, self.seed).unwrap();
        initial::with_maxwellian_velocities(disks, 1.0, self.seed).unwrap()
    }

    pub(crate) fn rule(&self) -> Rule {
        ContactDuration::new(
            Frictional::from_inelasticity(self.inelasticity, self.inelasticity, self.friction).unwrap(),
            1e-5,
        )
        .unwrap()
    }

    pub(crate) fn builder(&self) -> SimulationBuilder<Rule, Container> {
        Simulation::builder(self.rule(), self.boundary())
            .disks(self.disks())
            .gravity(self.gravity)
            .seed(self.seed)
            .starting_at(self.start)
    }

    pub(crate) fn simulation(&self) -> Simulation<Rule> {
        self.builder().build().unwrap()
    }
}

/// An elastic gas without friction in a closed box.
pub(crate) fn elastic_gas(count: usize, width: f64, height: f64, gravity: f64) -> Simulation<Elastic> {
    elastic_gas_at(0.0, count, width, height, gravity)
}

/// Returns the same gas, started at this time.
pub(crate) fn elastic_gas_at(
    start: f64,
    count: usize,
    width: f64,
    height: f64,
    gravity: f64,
) -> Simulation<Elastic> {
    let boundary = Container::closed(width, height).unwrap();
    let disks = initial::lattice(&boundary, count, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 4).unwrap();
    Simulation::builder(Elastic, boundary).disks(disks).gravity(gravity).starting_at(start).build().unwrap()
}

/// All collisions of a run until `end`, and the disks after it.
pub(crate) fn history<S: EventScheduler>(
    mut simulation: Simulation<Rule, Container, S>,
    end: f64,
) -> (Vec<Collision>, Vec<Disk>) {
    let mut log = Log(Vec::new());
    simulation.run_until(end, &mut log).unwrap();
    (log.0, simulation.disks())
}

/// Keeps all collisions.
pub(crate) struct Log(pub(crate) Vec<Collision>);

impl Observer for Log {
    fn on_collision(&mut self, collision: &Collision) {
        self.0.push(*collision);
    }
}

/// A builder of a few disks between a floor that shakes and a lid that heats.
pub(crate) fn shaken_and_heated() -> SimulationBuilder<Frictional, Container> {
    let walls =
        Container::closed(12.0, 10.0).unwrap().with_motion(Wall::Floor, Sinusoidal::new(0.1, 9.0).unwrap());
    let walls = walls.unwrap().with_temperature(Wall::Lid, Thermal::new(0.7).unwrap()).unwrap();
    let disks = initial::lattice(&walls, 25, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let rule = Frictional::from_inelasticity(0.02, 0.02, 0.2).unwrap();
    Simulation::builder(rule, walls).disks(disks).gravity(0.05).seed(5)
}
