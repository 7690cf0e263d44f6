//! Physics in a drum: a user's boundary, with a rule, an observable and a scheduler of the same user.

use downstream::angular_momentum::AngularMomentum;
use downstream::drum::Drum;
use downstream::lazy_heap::LazyHeap;
use downstream::viscoelastic::Viscoelastic;
use granular_edmd::collision::{CollisionRule, ContactDuration};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Energies, SampleTimes, Series, Snapshot, on_sample};
use granular_edmd::scheduler::{EventScheduler, LinearScan, TournamentTree};
use granular_edmd::simulation::BuildError;
use granular_edmd::{Disk, Simulation, initial};

const RADIUS: f64 = 8.0;
const ABOUT: AngularMomentum = AngularMomentum { about: DVec2::ZERO };

fn disks(count: usize, drum: &Drum, seed: u64) -> Vec<Disk> {
    let disks = initial::scattered(drum, count, 0.5, RADIUS, seed).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, seed).unwrap()
}

fn filled<R: CollisionRule>(rule: R, drum: Drum, gravity: f64) -> Simulation<R, Drum> {
    Simulation::builder(rule, drum).disks(disks(60, &drum, 5)).gravity(gravity).build().unwrap()
}

fn farthest(snapshot: &Snapshot<'_>) -> f64 {
    snapshot.disks().iter().map(|disk| disk.position().length() + disk.radius()).fold(0.0, f64::max)
}

#[test]
fn elastic_disks_keep_energy_and_stay_inside() {
    let drum = Drum::new(RADIUS).unwrap();
    let mut simulation = filled(Viscoelastic::new(0.0, 0.0).unwrap(), drum, 0.3);
    let before = simulation.measure(&Energies).total();
    let mut reach = 0.0_f64;
    let mut watch =
        on_sample(SampleTimes::every(0.37).unwrap(), |s: &Snapshot<'_>| reach = reach.max(farthest(s)));
    simulation.run_until(300.0, &mut watch).unwrap();
    let after = simulation.measure(&Energies).total();
    assert!((after / before - 1.0).abs() < 1e-10, "{before} {after}");
    assert!(reach <= RADIUS + 1e-9, "{reach}");
    assert!(reach >= RADIUS - 1e-2, "{reach}");
    assert!(simulation.counters().wall_collisions > 1000);
    assert!(simulation.counters().max_overlap < 1e-9);
}

#[test]
fn a_smooth_drum_cannot_turn_the_disks() {
    let drum = Drum::new(RADIUS).unwrap().turning(3.0);
    let mut simulation = filled(Viscoelastic::new(0.1, 0.0).unwrap(), drum, 0.0);
    let before = simulation.measure(&ABOUT);
    let mut series = Series::new(ABOUT, SampleTimes::every(1.0).unwrap());
    simulation.run_until(100.0, &mut series).unwrap();
    assert!(
        series.values().iter().all(|value| (value - before).abs() < 1e-9),
        "{before} {:?}",
        series.values()
    );
}

#[test]
fn a_rough_drum_takes_the_disks_along() {
    for angular_velocity in [-0.5, 0.5] {
        let drum = Drum::new(RADIUS).unwrap().turning(angular_velocity);
        // Smooth disks: rough ones would roll between each other and the wall ever faster, and collapse.
        let drum = drum.with_rule(Viscoelastic::new(0.0, 0.5).unwrap());
        let mut simulation = filled(Viscoelastic::new(0.0, 0.0).unwrap(), drum, 0.0);
        simulation.run_until(150.0, &mut ()).unwrap();
        let disks = simulation.disks();
        let inertia: f64 =
            disks.iter().map(|d| d.mass() * d.position().length_squared() + d.moment_of_inertia()).sum();
        let mean = simulation.measure(&ABOUT) / inertia;
        assert!(mean / angular_velocity > 0.2, "{mean}");
    }
}

#[test]
fn all_schedulers_give_the_same_bits() {
    fn last_state(scheduler: impl EventScheduler) -> Vec<Disk> {
        let drum = Drum::new(RADIUS).unwrap().turning(1.0);
        let rule = ContactDuration::new(Viscoelastic::new(0.05, 0.3).unwrap(), 1e-5).unwrap();
        let disks = disks(60, &drum, 5);
        let builder = Simulation::builder(rule, drum).disks(disks).gravity(0.1);
        let mut simulation = builder.scheduler(scheduler).build().unwrap();
        simulation.run_until(15.0, &mut ()).unwrap();
        assert!(simulation.counters().disk_collisions > 300);
        simulation.disks()
    }
    let ours = last_state(TournamentTree::new());
    assert_eq!(ours, last_state(LazyHeap::default()));
    assert_eq!(ours, last_state(LinearScan::default()));
    assert_eq!(ours, last_state(Box::new(LazyHeap::default()) as Box<dyn EventScheduler>));
}

#[test]
fn a_disk_outside_the_drum_is_refused() {
    let drum = Drum::new(RADIUS).unwrap();
    let corner = Disk::new(DVec2::splat(6.0), 0.5).unwrap();
    let error =
        Simulation::builder(Viscoelastic::new(0.0, 0.0).unwrap(), drum).disks([corner]).build().unwrap_err();
    assert!(matches!(&error, BuildError::OverlapsWall { disk: 0, wall, .. } if wall == "drum"), "{error}");
}

#[test]
fn lone_disks_fly_from_wall_to_wall_as_geometry_says() {
    // Without gravity, every chord of a circle is as long as the last.
    let drum = Drum::new(RADIUS).unwrap();
    let disk = Disk::new(DVec2::new(3.0, 1.0), 0.5).unwrap().with_velocity(DVec2::new(0.8, 0.6)).unwrap();
    let mut simulation =
        Simulation::builder(Viscoelastic::new(0.0, 0.0).unwrap(), drum).disks([disk]).build().unwrap();
    let mut times = Vec::new();
    let mut watch = granular_edmd::observable::on_collision(|c| times.push(c.time));
    simulation.run_until(1000.0, &mut watch).unwrap();
    let distance = disk.position().perp_dot(disk.velocity());
    let chord = 2.0 * ((RADIUS - 0.5).powi(2) - distance * distance).sqrt();
    assert!(times.len() > 60);
    assert!(times.windows(2).all(|w| (w[1] - w[0] - chord).abs() < 1e-9), "{chord} {times:?}");
}
