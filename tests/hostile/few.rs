//! Zero, one and two of everything, and extreme numbers where they are not checked by name. Each gives an
//! answer or an error, at once.

use granular_edmd::boundary::{Boundary, Container, Probe, Region, Wall};
use granular_edmd::collision::{Elastic, Encounter, Frictional, collide};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::{
    IsoLine, Maxwellian, MonteCarlo, effective_inelasticity, friction_of_largest_loss,
    frictionless_energy_change, mean_energy_change, sticking_fraction,
};
use granular_edmd::observable::{
    CenterOfMass, DenseLayer, Energies, EnergyChangeProfile, Fields, Grid, HeightProfile, OrderParameters,
    SampleTimes, Sampled, Temperatures,
};
use granular_edmd::statistics::block_average;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};

use support::schedulers::SCHEDULERS;

/// Sizes from the smallest number to the largest.
const SIZES: [f64; 12] = [5e-324, 1e-310, 1e-200, 1e-30, 1e-20, 1e-6, 0.5, 1.0, 1e6, 1e30, 1e200, f64::MAX];

/// Counts of something.
const COUNTS: [usize; 6] = [0, 1, 2, 3, 1 << 40, usize::MAX];

fn times() -> SampleTimes {
    SampleTimes::every(1.0).unwrap()
}

#[test]
fn a_run_of_none_one_or_two_is_measured_under_each_scheduler() {
    let container = Container::closed(5.0, 5.0).unwrap();
    for (count, scheduler) in (0..3).flat_map(|count| SCHEDULERS.map(|scheduler| (count, scheduler))) {
        let disks = initial::lattice(&container, count, 0.5).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
        let builder = Simulation::builder(Elastic, container.clone()).disks(disks).scheduler(scheduler());
        let mut run = builder.build().unwrap();
        let mut watched = (
            Sampled::new(HeightProfile::new(0.0, 5.0, 5).unwrap(), times()),
            Sampled::new(Fields::new(grid(2, 2).unwrap()), times()),
        );
        run.run_until(20.0, &mut watched).unwrap();
        let (order, height) = (run.measure(&OrderParameters), run.measure(&CenterOfMass).y);
        let (energy, temperature) = (run.measure(&Energies), run.measure(&Temperatures));
        let measured = [order.one_roll, order.two_rolls, height, energy.rotational, temperature.vertical];
        assert!(count == 0 || measured.iter().all(|number| number.is_finite()), "{count}: {measured:?}");
        assert_eq!(watched.0.samples(), 20);
        assert_eq!(run.len(), count);
    }
}

fn grid(columns: usize, rows: usize) -> Result<Grid, granular_edmd::ParameterError> {
    Grid::new(Region::new(DVec2::ZERO, DVec2::splat(5.0)), columns, rows)
}

#[test]
fn grids_and_profiles_have_a_number_of_cells_that_fits_into_memory() {
    for count in COUNTS {
        let possible = (1..100).contains(&count);
        assert_eq!(HeightProfile::new(0.0, 1.0, count).is_ok(), possible, "{count}");
        assert_eq!(EnergyChangeProfile::new(0.0, 1.0, count).is_ok(), possible, "{count}");
        assert_eq!(grid(count, 1).is_ok(), possible, "{count}");
        assert_eq!(grid(count, count).is_ok(), possible, "{count}");
    }
}

#[test]
fn disks_of_any_size_find_their_places_or_an_error_at_once() {
    let base = BiParabolic::new(0.1, 3.0).unwrap();
    for (size, count) in SIZES.into_iter().flat_map(|size| [0, 1, 2].map(|count| (size, count))) {
        for container in [Container::closed(1.0, 1.0), Container::open(1e9), Container::closed(1e200, 1e200)]
        {
            let container = container.unwrap().with_motion(Wall::Floor, base).unwrap();
            for container in [container.clone(), container.with_periodic_sides().unwrap()] {
                let lattice = initial::lattice(&container, count, size);
                let random = initial::scattered(&container, count, size, 10.0, 1);
                for disks in [lattice, random].into_iter().flatten() {
                    assert_eq!(disks.len(), count);
                    let overlap =
                        |disk: &Disk| container.overlap(&Probe::new(disk.position(), disk.radius(), 0.0));
                    assert!(disks.iter().all(|disk| overlap(disk).is_none()), "{size:e}");
                }
            }
        }
    }
}

#[test]
fn means_of_none_one_or_two_are_answers_or_errors() {
    for count in 0..=2 {
        assert_eq!(block_average(&[0.0, 1.0][..count]).is_ok(), count == 2);
    }
    assert!(DenseLayer::among([]).is_none());
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(block_average(&[bad, 1.0]).is_err());
    }
}

#[test]
fn kinetic_answers_are_finite_and_within_their_bounds() {
    for temperature in SIZES {
        let Ok(gas) = Maxwellian::new(temperature) else { continue };
        assert!((1e-30..=1e30).contains(&temperature));
        for friction in SIZES {
            let Ok(rule) = Frictional::from_inelasticity(0.05, 0.05, friction) else { continue };
            let change = mean_energy_change(&rule, &gas) / temperature;
            assert!((-4.0..=0.0).contains(&change), "{temperature:e} {friction:e}: {change}");
            assert!((0.0..=1.0).contains(&sticking_fraction(&rule, &gas)), "{temperature:e} {friction:e}");
            let largest = friction_of_largest_loss(&rule, &gas);
            assert!(largest.is_none_or(f64::is_finite), "{temperature:e} {friction:e}: {largest:?}");
            for loss in [0.0, -0.1, -1.0, -1e300] {
                let line = IsoLine::new(loss * temperature.min(1.0), &gas).unwrap();
                let found = line.inelasticities(friction).unwrap();
                assert!(found.iter().all(|q| (0.0..=0.5).contains(q)), "{friction:e} {loss}: {found:?}");
            }
            let sampled = MonteCarlo::new(1).with_samples(1).mean_energy_change(&rule, &gas);
            assert!(sampled.mean().is_finite(), "{temperature:e} {friction:e}");
        }
        for change in SIZES {
            if let Ok(q) = effective_inelasticity(-change, temperature) {
                assert!((0.0..=0.5).contains(&q), "{change:e} {temperature:e}: {q}");
            }
        }
        assert!(frictionless_energy_change(0.5, temperature).unwrap().is_finite());
    }
}

#[test]
fn collisions_of_extreme_disks_have_finite_ends() {
    let disk = |size: f64, speed: f64, x: f64| {
        let disk = Disk::new(DVec2::new(x, 0.0), size)?.with_mass(size)?;
        disk.with_velocity(DVec2::new(-speed * x.signum(), 0.3 * speed))
    };
    for (one, other) in SIZES.into_iter().flat_map(|one| SIZES.map(|other| (one, other))) {
        for speed in SIZES {
            let (Ok(first), Ok(second)) = (disk(one, speed, -1.0), disk(other, speed, 1.0)) else { continue };
            let rule = Frictional::from_inelasticity(0.05, 0.05, 0.1).unwrap();
            let Encounter { first, second, .. } = collide(&rule, &first, &second);
            assert!(
                first.velocity().is_finite() && second.velocity().is_finite(),
                "{one:e} {other:e} {speed:e}"
            );
        }
    }
}
