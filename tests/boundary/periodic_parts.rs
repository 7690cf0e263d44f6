//! Parts beyond the sides of a periodic container: all their images count.

use granular_edmd::boundary::{Boundary, Brick, Container, Part, Probe, WallError, laws};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BuildError;
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Simulation};
use support::cases::few;

fn point(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn periodic() -> Container {
    Container::closed(10.0, 40.0).unwrap().with_periodic_sides().unwrap()
}

/// Counts the collisions of a disk that goes to and fro along a line, with a part in a container of period
/// 10.
fn collisions(part: Part) -> u64 {
    let disk = Disk::new(point(2.0, 20.0), 0.5).unwrap().with_velocity(point(1.0, 0.0)).unwrap();
    let vessel = periodic().with_part("part", part).unwrap();
    let mut run = Simulation::builder(Elastic, vessel).disks([disk]).build().unwrap();
    run.run_until(30.0, &mut ()).unwrap();
    run.counters().wall_collisions
}

#[test]
fn a_part_several_periods_away_is_there() {
    let peg = |x: f64| collisions(Part::peg(point(x, 20.0), 1.0).unwrap());
    let expected = peg(5.0);
    assert!(expected >= 3);
    for x in [15.0, -5.0, 25.0, -25.0, 105.0, 1e6 + 5.0] {
        assert_eq!(peg(x), expected, "{x}");
    }
}

/// What stands in a periodic container is the same after a shift by any number of periods.
#[test]
fn parts_of_several_periods_are_whole() {
    let long = |shift: f64| Part::polyline([point(shift, 1.0), point(shift + 35.0, 36.0)]).unwrap();
    let arm = |shift: f64| {
        let arm = Part::polyline([point(shift + 5.0, 20.0), point(shift + 30.0, 20.0)]).unwrap();
        arm.with_rotation(point(shift + 5.0, 20.0), 0.3).unwrap()
    };
    let traveler = |shift: f64| {
        let peg = Part::peg(point(shift + 5.0, 20.0), 1.0).unwrap();
        peg.with_motion(DVec2::X, Sinusoidal::new(25.0, 0.2).unwrap()).unwrap()
    };
    let parts: [&dyn Fn(f64) -> Part; 3] = [&long, &arm, &traveler];
    for (number, part) in parts.iter().enumerate() {
        let vessel = |shift: f64| periodic().with_part("part", part(shift)).unwrap();
        for seed in few(0..4, 4) {
            assert_eq!(laws::check(&mut vessel(0.0), 0.4, 1.0, seed), Ok(()), "{number}, seed {seed}");
        }
        let (here, there) = (vessel(0.0), vessel(-70.0));
        for k in 0..4000 {
            let place = point(f64::from(k % 40) * 0.25, f64::from(k / 40) * 0.4);
            let depths = [&here, &there].map(|vessel| {
                vessel.overlap(&Probe::new(place, 0.5, 1.3)).map_or(0.0, |overlap| overlap.depth)
            });
            assert!((depths[0] - depths[1]).abs() < 1e-12, "{number} at {place}: {depths:?}");
        }
    }
}

#[test]
fn a_part_across_too_many_periods_is_refused() {
    let long = Part::polyline([point(0.0, 1.0), point(1000.0, 1.0)]).unwrap();
    let error = periodic().with_part("long", long).unwrap_err();
    assert!(matches!(error, WallError::TooManyPeriods { .. }), "{error}");
    let error = error.to_string();
    assert!(error.contains("\"long\" extends over 100 periods"), "{error}");
    // Each of an arm's 20 times 20 images would be in many cells.
    let both = Container::periodic(10.0, 10.0).unwrap();
    let arm = Part::polyline([point(0.0, 1.0), point(100.0, 1.0)]).unwrap();
    let arm = arm.with_rotation(DVec2::ZERO, 0.1).unwrap();
    let error = both.with_part("arm", arm).unwrap_err().to_string();
    assert!(error.contains("at most 256 are possible"), "{error}");
    let upward = Part::polyline([point(3.0, 1.0), point(3.0, 1e6)]).unwrap();
    assert!(periodic().with_part("upward", upward).is_ok());
}

/// A hollow that a disk fills exactly, or up to rounding, is refused by name.
#[test]
fn a_disk_as_large_as_a_hollow_is_refused() {
    let pit = |radius: f64| {
        let center = point(5.0, 4.0);
        let arc = Brick::arc(center, radius, std::f64::consts::PI, std::f64::consts::TAU).unwrap();
        let side = |from: f64, to: f64| Brick::segment(point(from, 4.0), point(to, 4.0)).unwrap();
        let pit = Part::new([side(0.0, 5.0 - radius), arc, side(5.0 + radius, 10.0)]).unwrap();
        Container::closed(10.0, 10.0).unwrap().with_part("pit", pit).unwrap()
    };
    let falling = Disk::new(point(5.0, 6.0), 0.5).unwrap();
    let run = |radius: f64| Simulation::builder(Elastic, pit(radius)).disks([falling]).gravity(1.0).build();
    for radius in [0.5, 0.5_f64.next_up(), 0.5_f64.next_down(), 0.5 * (1.0 + 1e-12), 0.5 * (1.0 - 1e-12)] {
        let error = run(radius).unwrap_err();
        assert!(matches!(error, BuildError::TightFit { disk: 0, .. }), "{radius}: {error}");
        assert!(error.to_string().contains("hollow of the wall \"pit"), "{error}");
    }
    for radius in [0.6, 0.5 + 1e-6, 0.5 - 1e-6, 0.3] {
        let mut run = run(radius).unwrap();
        while run.counters().wall_collisions < 3 {
            run.step_until(100.0, &mut ()).unwrap();
            let lowest = run.disks()[0].position().y - 0.5;
            assert!(lowest > 4.0 - radius - 1e-6, "{radius}: {lowest}");
        }
    }
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 0.5).unwrap())]).unwrap();
    let disk = Disk::new(DVec2::ZERO, 0.5).unwrap();
    let error = Simulation::builder(Elastic, drum.clone()).disks([disk]).build().unwrap_err();
    assert!(matches!(error, BuildError::TightFit { .. }), "{error}");
    let room = Container::closed(10.0, 10.0).unwrap();
    let mut run = Simulation::builder(Elastic, room).disks([falling]).build().unwrap();
    assert!(run.set_boundary(pit(0.5)).is_err());
    assert!(drum.tight_fit(0.4).is_none());
}
