//! All of the user's parts at once, and all of them boxed.

use downstream::angular_momentum::AngularMomentum;
use downstream::drum::Drum;
use downstream::hardest_impacts::HardestImpacts;
use downstream::lazy_heap::LazyHeap;
use downstream::viscoelastic::Viscoelastic;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::{CollisionRule, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{self, CollisionCounts, Energies, Observer, SampleTimes, Series};
use granular_edmd::scheduler::EventScheduler;
use granular_edmd::{Disk, Simulation, initial};

const ABOUT: AngularMomentum = AngularMomentum { about: DVec2::ZERO };

fn drum() -> Drum {
    Drum::new(6.0).unwrap().turning(0.7)
}

type Boxed = Simulation<Box<dyn CollisionRule>, Box<dyn Boundary>, Box<dyn EventScheduler>>;

fn disks() -> Vec<Disk> {
    let disks = initial::scattered(&drum(), 40, 0.5, 6.0, 1).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap()
}

fn boxed() -> Boxed {
    let rule: Box<dyn CollisionRule> = Box::new(Viscoelastic::new(0.05, 0.2).unwrap());
    let boundary: Box<dyn Boundary> = Box::new(drum());
    let scheduler: Box<dyn EventScheduler> = Box::new(LazyHeap::default());
    Simulation::builder(rule, boundary).disks(disks()).gravity(0.02).scheduler(scheduler).build().unwrap()
}

fn every(interval: f64) -> SampleTimes {
    SampleTimes::every(interval).unwrap()
}

#[test]
fn boxes_change_nothing() {
    let mut plain = Simulation::builder(Viscoelastic::new(0.05, 0.2).unwrap(), drum())
        .disks(disks())
        .gravity(0.02)
        .build()
        .unwrap();
    plain.run_until(20.0, &mut ()).unwrap();
    let mut boxed = boxed();
    boxed.run_until(20.0, &mut ()).unwrap();
    assert_eq!(plain.disks(), boxed.disks());
    assert_eq!(plain.counters(), boxed.counters());
}

#[test]
fn a_vector_of_observers_sees_what_each_would_see_alone() {
    let mut simulation = boxed();
    let mut impacts = HardestImpacts::new(every(1.5));
    let mut momentum = Series::new(ABOUT, every(1.0));
    let mut energies = Series::new(Energies, every(0.7));
    let mut counts = CollisionCounts::default();
    let mut observers: Vec<Box<dyn Observer + '_>> = vec![
        Box::new(&mut impacts),
        Box::new(&mut momentum),
        Box::new(&mut energies),
        Box::new(&mut counts),
        Box::new(()),
    ];
    simulation.run_until(21.0, &mut observers).unwrap();
    drop(observers);

    let mut alone = boxed();
    let mut impacts_alone = HardestImpacts::new(every(1.5));
    alone.run_until(21.0, &mut impacts_alone).unwrap();
    assert_eq!(impacts, impacts_alone);
    assert_eq!(impacts.hardest.len(), 14);
    assert!(impacts.hardest.iter().all(|row| row[0] > 0.0));

    let mut momentum_alone = Series::new(ABOUT, every(1.0));
    self::boxed().run_until(21.0, &mut momentum_alone).unwrap();
    assert_eq!(momentum.values(), momentum_alone.values());
    assert_eq!(momentum.times().len(), 21);
    assert_eq!(energies.times().len(), 30);
    assert_eq!(counts.disk_collisions(), simulation.counters().disk_collisions);
    assert_eq!(counts.wall_collisions(), simulation.counters().wall_collisions);
    assert_eq!(simulation.disks(), alone.disks());
}

#[test]
fn observers_keep_their_contract() {
    observable::laws::check(&mut HardestImpacts::new(every(1.5))).unwrap();
    observable::laws::check(&mut Series::new(ABOUT, every(0.1))).unwrap();
}

#[test]
fn rule_and_boundary_can_be_changed_underway() {
    let mut simulation = boxed();
    simulation.run_until(5.0, &mut ()).unwrap();
    simulation.set_rule(Box::new(Smooth::from_inelasticity(0.0).unwrap()));
    simulation.set_boundary(Box::new(Drum::new(9.0).unwrap())).unwrap();
    let before = simulation.measure(&Energies).total();
    simulation.run_until(200.0, &mut ()).unwrap();
    assert!((simulation.measure(&Energies).total() / before - 1.0).abs() < 1e-10);
    let farthest = simulation.disks().iter().map(|disk| disk.position().length()).fold(0.0, f64::max);
    assert!(farthest > 6.0 && farthest < 8.5 + 1e-9, "{farthest}");
    assert!(simulation.set_boundary(Box::new(Drum::new(3.0).unwrap())).is_err());
}
