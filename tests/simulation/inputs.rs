//! Inputs that cannot be run. Each is refused with an error that names it.

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::initial::{self, PlacementError};
use granular_edmd::observable::{Energies, Observer, SampleTimes, Series, Snapshot};
use granular_edmd::simulation::{BuildError, RunError};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation};

fn at(x: f64, y: f64) -> Disk {
    Disk::new(DVec2::new(x, y), 0.5).unwrap()
}

fn build(boundary: Container, disks: &[Disk]) -> Result<Simulation<Elastic>, BuildError> {
    Simulation::builder(Elastic, boundary).disks(disks.iter().copied()).gravity(0.1).build()
}

fn closed() -> Container {
    Container::closed(8.0, 6.0).unwrap()
}

#[test]
fn containers_refuse_sizes_that_are_none() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Container::closed(value, 1.0).unwrap_err();
        assert!(
            error.to_string().starts_with("width") && !(error.value() > 0.0 && value.is_finite()),
            "{error}"
        );
        assert!(Container::closed(1.0, value).unwrap_err().to_string().starts_with("height"));
        assert!(Container::open(value).is_err());
    }
    let error = Container::open(3.0)
        .unwrap()
        .with_motion(Wall::Lid, BiParabolic::new(0.1, 1.0).unwrap())
        .unwrap_err();
    assert!(error.to_string().contains("lid"));
}

#[test]
fn times_and_gravity_must_be_finite() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let builder = || Simulation::builder(Elastic, closed()).disks([at(1.0, 1.0)]);
        assert!(builder().gravity(value).build().unwrap_err().to_string().contains("gravity"));
        let mut run = builder().build().unwrap();
        assert!(run.set_gravity(value).unwrap_err().to_string().contains("gravity"));
        assert!(builder().starting_at(value).build().unwrap_err().to_string().contains("start time"));
    }
}

/// The square of the speed of a fall must be a number.
#[test]
fn gravity_has_a_bound() {
    for gravity in [1e61, -1e61, f64::MAX] {
        let builder = || Simulation::builder(Elastic, closed()).disks([at(1.0, 1.0)]);
        assert_eq!(builder().build().unwrap().set_gravity(gravity).unwrap_err().value(), gravity);
        let error = builder().gravity(gravity).build().unwrap_err();
        assert!(matches!(error, BuildError::Parameter(_)), "{error}");
    }
}

#[test]
fn disks_must_be_inside_and_apart() {
    let error = build(closed(), &[at(2.0, 2.0), at(9.0, 2.0)]).unwrap_err();
    assert!(matches!(error, BuildError::Outside { disk: 1, x: 9.0, y: 2.0, .. }), "{error}");
    assert!(
        error.to_string().ends_with("(9, 2) is outside the domain: x from 0 to 8, y from 0 to 6"),
        "{error}"
    );
    let error = build(closed(), &[at(2.0, 2.0), at(4.0, 0.3)]).unwrap_err();
    assert!(matches!(&error, BuildError::OverlapsWall { disk: 1, wall, .. } if wall == "floor"), "{error}");
    assert!(error.to_string().contains("disk 1") && error.to_string().contains("0.2"), "{error}");
    let error = build(closed(), &[at(2.0, 2.0), at(5.0, 2.0), at(2.5, 2.5)]).unwrap_err();
    assert!(matches!(error, BuildError::Overlap { first: 0, second: 2, .. }), "{error}");
    let error = build(closed(), &[at(2.0, 2.0), at(2.0, 2.0)]).unwrap_err();
    assert_eq!(error.to_string(), "disks 0 and 1 at (2, 2) and (2, 2) overlap by 1");
    let error = build(closed().with_periodic_sides().unwrap(), &[at(0.2, 2.0), at(7.8, 2.0)]).unwrap_err();
    assert!(matches!(error, BuildError::Overlap { first: 0, second: 1, .. }), "across the sides: {error}");
}

#[test]
fn touching_is_not_overlapping() {
    let mut touching = build(closed(), &[at(0.5, 0.5), at(1.5, 0.5), at(7.5, 5.5)]).unwrap();
    touching.step_until(1.0, &mut ()).unwrap();
    let third = 1.0 / 3.0;
    let disks = [at(third + 0.5, 2.0), at(third + 1.5, 2.0), at(third + 2.5, 2.0)];
    build(closed(), &disks).unwrap().run_until(0.1, &mut ()).unwrap();
}

#[test]
fn boxes_too_thin_for_a_disk_are_refused() {
    for boundary in [Container::closed(0.9, 6.0), Container::closed(6.0, 0.9)] {
        let boundary = boundary.unwrap();
        let error = build(boundary.clone(), &[at(0.45, 0.45)]).unwrap_err();
        assert!(matches!(error, BuildError::OverlapsWall { disk: 0, .. }), "{error}");
        assert_eq!(
            initial::lattice(&boundary, 1, 0.5).unwrap_err(),
            PlacementError::NoRoom { count: 1, placed: 0, radius: 0.5, interior: boundary.interior() }
        );
        assert!(matches!(
            initial::scattered(&boundary, 2, 0.5, 5.0, 1),
            Err(PlacementError::NoRoom { placed: 0, .. })
        ));
    }
    for width in [0.3, 1.0, 3.9] {
        let narrow = Container::closed(width, 6.0).unwrap().with_periodic_sides().unwrap();
        let error = build(narrow, &[at(0.1, 2.0)]).unwrap_err();
        assert!(matches!(error, BuildError::DomainTooSmall { diameter: 1.0, .. }), "{error}");
    }
    build(Container::closed(4.1, 6.0).unwrap().with_periodic_sides().unwrap(), &[at(0.1, 2.0)]).unwrap();
    // A disk in a tube of its own width has nowhere to go.
    let mut tube = build(Container::closed(1.0, 6.0).unwrap(), &[at(0.5, 2.0)]).unwrap();
    tube.run_until(10.0, &mut ()).unwrap();
}

#[test]
fn none_one_and_two_disks_run() {
    for count in 0..3 {
        for periodic in [false, true] {
            let boundary = if periodic { closed().with_periodic_sides().unwrap() } else { closed() };
            let disks = initial::lattice(&boundary, count, 0.5).unwrap();
            let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
            let mut simulation = build(boundary.clone(), &disks).unwrap();
            simulation.run_until(20.0, &mut Series::new(Energies, SampleTimes::every(1.0).unwrap())).unwrap();
            assert_eq!(simulation.disks().len(), count);
            assert_eq!(initial::scattered(&boundary, count, 0.5, 6.0, 1).unwrap().len(), count);
        }
    }
    // Without disks, none is too large for a narrow periodic box.
    build(Container::closed(0.1, 0.1).unwrap().with_periodic_sides().unwrap(), &[])
        .unwrap()
        .run_until(1.0, &mut ())
        .unwrap();
}

#[test]
fn initial_states_refuse_what_makes_no_sense() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(initial::lattice(&closed(), 3, value), Err(PlacementError::Parameter(_))));
        assert!(matches!(initial::scattered(&closed(), 3, value, 5.0, 1), Err(PlacementError::Parameter(_))));
        assert!(matches!(initial::scattered(&closed(), 3, 0.5, value, 1), Err(PlacementError::Parameter(_))));
    }
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(initial::with_maxwellian_velocities(vec![at(1.0, 1.0)], value, 1).is_err());
    }
    let full = initial::lattice(&closed(), 1000, 0.5).unwrap_err();
    assert!(matches!(full, PlacementError::NoRoom { count: 1000, placed: 35..=48, .. }), "{full}");
    let full = initial::scattered(&closed(), 40, 0.5, 6.0, 1).unwrap_err();
    assert!(matches!(full, PlacementError::NoPosition { count: 40, placed: 15..40, .. }), "{full}");
}

#[test]
fn initial_states_are_accepted_by_the_builder() {
    let base = BiParabolic::new(0.4, 3.0).unwrap();
    for boundary in
        [closed(), closed().with_periodic_sides().unwrap(), closed().with_motion(Wall::Floor, base).unwrap()]
    {
        for start in [0.0, 0.7, 1e7] {
            for disks in [
                initial::lattice(&boundary, 24, 0.5).unwrap(),
                initial::scattered(&boundary, 12, 0.5, 6.0, 3).unwrap(),
            ] {
                let builder = Simulation::builder(Elastic, boundary.clone()).disks(disks).starting_at(start);
                assert!(builder.build().is_ok(), "{boundary:?}");
            }
        }
    }
}

#[test]
fn hostile_disks_end_in_an_error_or_run_but_do_not_hang() {
    for speed in [1e-100, 1e-9, 1e9, 1e50] {
        let disk = at(2.0, 2.0).with_velocity(DVec2::new(speed, 0.3 * speed)).unwrap();
        let mut simulation = build(closed(), &[disk, at(5.0, 3.0)]).unwrap();
        for _ in 0..1000 {
            if simulation.step_until(simulation.time() + 1.0, &mut ()).is_err() {
                break;
            }
        }
        assert!(simulation.disks().iter().all(|disk| disk.position().is_finite()), "{speed}");
    }
}

#[test]
fn velocities_whose_squares_overflow_or_vanish_are_refused() {
    for speed in [5e-324, 1e-290, -1e-101] {
        let slow = at(2.0, 2.0).with_velocity(DVec2::new(speed, 0.0)).unwrap();
        let error = build(closed(), &[slow]).unwrap_err().to_string();
        assert!(error.starts_with("speed of a disk must be 0 or at least 1e-100"), "{error}");
        let mut run = build(closed(), &[at(5.0, 3.0)]).unwrap();
        assert!(run.insert([slow]).is_err() && run.len() == 1);
        build(closed(), &[at(2.0, 2.0).with_velocity(DVec2::new(1.0, speed)).unwrap()]).unwrap();
    }
    let error = at(2.0, 2.0).with_velocity(DVec2::new(1e100, 0.0)).unwrap_err();
    assert_eq!(error.value(), 1e100);
    assert!(at(2.0, 2.0).with_angular_velocity(-1e61).is_err());
}

#[test]
fn an_observer_that_asks_for_the_same_sample_again_is_refused() {
    struct Stuck;
    impl Observer for Stuck {
        fn next_sample(&self) -> f64 {
            0.5
        }
        fn on_sample(&mut self, _: &Snapshot<'_>) {}
    }
    let error = build(closed(), &[at(2.0, 2.0)]).unwrap().run_until(1.0, &mut Stuck).unwrap_err();
    assert!(matches!(error, RunError::SampleTime { next: 0.5, .. }), "{error}");
}

#[test]
fn sampling_intervals_below_rounding_do_not_hang() {
    let times = SampleTimes::every(1e-30).unwrap().starting_at(1.0).unwrap();
    let mut series = Series::new(Energies, times);
    let mut simulation = build(closed(), &[at(2.0, 2.0)]).unwrap();
    // There is a sample at almost every double, so the run is stopped after a few.
    let _ = simulation.run_until(1.0 + 4.0 * f64::EPSILON, &mut series);
    assert!(series.times().len() <= 5, "{:?}", series.times());
}

/// The present is an offset from an epoch. Whatever both are, a run is at the time to which it was sent.
#[test]
fn odd_start_times_and_intervals_lose_no_sample() {
    for start in [0.1, -3.7, 1.0 / 3.0, 1e5 + 0.1, 12_345.678] {
        for interval in [0.3, 0.07, 1.0 / 7.0] {
            let disks = [at(2.0, 2.0).with_velocity(DVec2::new(1.0, 0.7)).unwrap(), at(5.0, 3.0)];
            let builder = Simulation::builder(Elastic, closed()).disks(disks).gravity(0.1).starting_at(start);
            let mut simulation = builder.build().unwrap();
            let times = SampleTimes::every(interval).unwrap().starting_at(start + interval).unwrap();
            let mut series = Series::new(Energies, times);
            for piece in 1..=50 {
                simulation.run_until(start + 4.0 * f64::from(piece) * interval, &mut series).unwrap();
            }
            simulation.set_gravity(0.2).unwrap();
            simulation.run_until(start + 300.0 * interval, &mut series).unwrap();
            assert!((299..=300).contains(&series.values().len()), "{start} {interval}");
            assert!(series.times().windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
