//! A ball on a plate: closed forms, the end of Zeno's bounces, and late times.

use granular_edmd::boundary::{Boundary, Container, Probe, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Energies, on_collision};
use granular_edmd::simulation::RunError;
use granular_edmd::wall::{BiParabolic, Sinusoidal};
use granular_edmd::{Disk, Simulation};

use crate::setups::Log;

/// A ball whose lowest point is this high above the floor.
fn ball(height: f64) -> Disk {
    Disk::new(DVec2::new(2.0, 0.5 + height), 0.5).unwrap()
}

fn open() -> Container {
    Container::open(4.0).unwrap()
}

/// Times and closing speeds of the touches before `end`, counted from the start.
fn touches<R: granular_edmd::collision::CollisionRule>(
    rule: R,
    disk: Disk,
    start: f64,
    end: f64,
) -> Vec<(f64, f64)> {
    let mut simulation =
        Simulation::builder(rule, open()).disks([disk]).gravity(1.0).starting_at(start).build().unwrap();
    let mut touches = Vec::new();
    let mut watch = on_collision(|c: &Collision| touches.push((c.time - start, c.contact.closing_speed())));
    simulation.run_until(start + end, &mut watch).unwrap();
    touches
}

#[test]
fn a_lossy_ball_bounces_as_the_closed_form_says() {
    // The formula is for height 1 and g = 1: bounce n comes 2 sqrt(2) r^n / (1 - r) before T = sqrt(2) (1 +
    // r) / (1 - r).
    let r: f64 = 0.8;
    let last = 2.0_f64.sqrt() * (1.0 + r) / (1.0 - r);
    assert!((last - 12.727_922_061_358).abs() < 1e-11);
    let touches = touches(Smooth::from_restitution(r).unwrap(), ball(1.0), 0.0, last - 1e-4);
    assert!(touches.len() > 40, "{}", touches.len());
    for (n, (time, speed)) in (0..).zip(touches) {
        let left = 2.0 * 2.0_f64.sqrt() * r.powi(n + 1) / (1.0 - r);
        let closing = 2.0_f64.sqrt() * r.powi(n);
        // Heights are rounded by some 1e-14. The slower the ball, the more this changes time and speed.
        let tolerance = 1e-11 + 1e-13 / closing;
        assert!((last - time - left).abs() < tolerance, "{n}: {} {left}", last - time);
        assert!((speed - closing).abs() < tolerance, "{n}: {speed} {closing}");
    }
}

#[test]
fn an_elastic_ball_bounces_for_ever_at_any_time() {
    let fall = (2.0 * 3.7_f64).sqrt();
    for start in [0.0, -1e6, 1e7, 1e7 + 0.1] {
        let mut simulation = Simulation::builder(Elastic, open())
            .disks([ball(3.7)])
            .gravity(1.0)
            .starting_at(start)
            .build()
            .unwrap();
        let before = simulation.measure(&Energies).total();
        let mut log = Log(Vec::new());
        simulation.run_until(start + 20_000.0, &mut log).unwrap();
        assert!(log.0.len() > 3000);
        for (n, collision) in log.0.iter().enumerate() {
            let expected = start + fall * (2.0 * n as f64 + 1.0);
            // Times are given in doubles. They are right to their last digits.
            let tolerance = 1e-12 * (1.0 + expected - start) + 2.0 * f64::EPSILON * expected.abs();
            assert!(
                (collision.time - expected).abs() < tolerance,
                "{start} {n}: {} {expected}",
                collision.time
            );
        }
        assert!((simulation.measure(&Energies).total() / before - 1.0).abs() < 1e-12, "{start}");
    }
}

#[test]
fn late_runs_see_the_same_base() {
    // After a whole number of periods (64 s, exact in doubles) the same run repeats.
    let base = BiParabolic::new(0.1, std::f64::consts::TAU).unwrap();
    let run = |start: f64| {
        let boundary = open().with_motion(Wall::Floor, base).unwrap();
        let mut simulation = Simulation::builder(Elastic, boundary)
            .disks([ball(1.0)])
            .gravity(1.0)
            .starting_at(start)
            .build()
            .unwrap();
        let mut log = Log(Vec::new());
        simulation.run_until(start + 30.0, &mut log).unwrap();
        log.0
    };
    let (early, late) = (run(0.0), run(10_000_000.0));
    assert!(early.len() > 5 && early.len() == late.len(), "{} {}", early.len(), late.len());
    for (a, b) in early.iter().zip(&late) {
        assert_eq!(a.contact, b.contact);
        assert!((b.time - 10_000_000.0 - a.time).abs() < 4e-9);
    }
}

#[test]
fn zeno_ends_the_run_and_contact_duration_saves_it() {
    let smooth = Smooth::from_restitution(0.5).unwrap();
    let zeno = 2.0_f64.sqrt() * 3.0;
    let stalled =
        |error| matches!(error, RunError::Stalled { disk: 0, time, .. } if (time - zeno).abs() < 1e-6);
    let rule = |duration| ContactDuration::new(smooth, duration).unwrap();
    let mut simulation =
        Simulation::builder(rule(1e-300), open()).disks([ball(1.0)]).gravity(1.0).build().unwrap();
    assert!(stalled(simulation.run_until(10.0, &mut ()).unwrap_err()));
    assert!((simulation.disks()[0].position().y - 0.5).abs() < 1e-9);

    // Bounces lower than the rounding of a position are bounces still.
    let mut low = Simulation::builder(rule(1e-6), open()).disks([ball(1.0)]).gravity(1.0).build().unwrap();
    low.run_until(4.28, &mut ()).unwrap();
    assert!(low.counters().contact_duration_collisions > 20_000);

    let mut saved = Simulation::builder(rule(1e-3), open()).disks([ball(1.0)]).gravity(1.0).build().unwrap();
    saved.run_until(20.0, &mut ()).unwrap();
    assert!(saved.counters().contact_duration_collisions > 1000);
    let height = saved.disks()[0].position().y - 0.5;
    assert!((-1e-9..1e-6).contains(&height), "{height}");
}

#[test]
fn a_run_that_stalled_goes_on_once_the_cause_is_gone() {
    let mut simulation = Simulation::builder(Smooth::from_restitution(0.5).unwrap(), open())
        .disks([ball(1.0)])
        .gravity(1.0)
        .build()
        .unwrap();
    assert!(matches!(simulation.run_until(10.0, &mut ()), Err(RunError::Stalled { .. })));
    simulation.set_gravity(-1.0).unwrap();
    simulation.run_until(10.0, &mut ()).unwrap();
    assert!(simulation.disks()[0].position().y > 10.0);
}

#[test]
fn disks_between_walls_collapse_with_an_error() {
    let disks = (0..20).map(|k| {
        let speed = DVec2::new(0.3 * f64::from(k % 7) - 1.0, 0.0);
        Disk::new(DVec2::new(1.0 + 1.1 * f64::from(k), 1.0), 0.5).unwrap().with_velocity(speed).unwrap()
    });
    let mut simulation = Simulation::builder(
        Frictional::from_inelasticity(0.4, 0.4, 0.1).unwrap(),
        Container::closed(24.0, 2.0).unwrap(),
    )
    .disks(disks)
    .build()
    .unwrap();
    let error = simulation.run_until(1e5, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Stalled { .. }), "{error}");
}

#[test]
fn a_disk_at_rest_on_the_floor_is_an_error_that_says_so() {
    let mut simulation =
        Simulation::builder(Elastic, open()).disks([ball(0.0), ball(3.0)]).gravity(1.0).build().unwrap();
    let error = simulation.run_until(1.0, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Stalled { disk: 0, time, .. } if time < 1e-6), "{error}");
    assert!(error.to_string().contains("disk 0") && error.to_string().contains("at rest"), "{error}");
}

/// The bounces of the ball become lower than rounding. None of them may go deeper into the floor than the one
/// before.
#[test]
fn a_lossy_ball_does_not_sink_into_a_floor_of_varying_acceleration() {
    for restitution in [0.0, 0.5, 0.9] {
        let floor = Sinusoidal::new(0.1, 2.0).unwrap();
        let mut simulation = Simulation::builder(
            Smooth::from_restitution(restitution).unwrap(),
            open().with_motion(Wall::Floor, floor).unwrap(),
        )
        .disks([ball(0.5)])
        .gravity(1.0)
        .build()
        .unwrap();
        let error = simulation.run_until(20.0, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::Stalled { disk: 0, .. }), "{restitution}: {error}");
        let mut floor = simulation.boundary().clone();
        floor.set_time_origin(simulation.time());
        let overlap = floor.overlap(&Probe::new(simulation.disks()[0].position(), 0.5, 0.0));
        assert!(overlap.is_none_or(|overlap| overlap.depth < 1e-9), "{restitution}: {overlap:?}");
    }
}
