//! Measures of known states and of chance: pairs, displacements, stress, correlations, distributions.

use granular_edmd::boundary::{Container, Domain, Region, Wall};
use granular_edmd::collision::{Contact, Elastic, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Collision, CollisionHistograms, Grid, MeanSquaredDisplacement, Moment, Observable, Observer,
    PairCorrelation, Partner, SampleTimes, Snapshot, Stress, Temperatures, TemperaturesAboutFlow,
    TimeCorrelation, Velocities, VelocityDistribution, WallStress, from_fn,
};
use granular_edmd::statistics::{Estimate, Histogram};
use granular_edmd::{Disk, Kind, ParameterError, Simulation, initial};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

type Outcome = Result<(), Box<dyn std::error::Error>>;

const BOX: Domain = Domain::new(0.0, 20.0, 0.0, 10.0);

fn times() -> Result<SampleTimes, ParameterError> {
    SampleTimes::every(1.0)
}

fn uniform(generator: &mut Xoshiro256PlusPlus) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A normal variable, as a sum of 12 uniform numbers.
fn normal(generator: &mut Xoshiro256PlusPlus) -> f64 {
    (0..12).map(|_| uniform(generator)).sum::<f64>() - 6.0
}

/// Points at random places in the box, two of three of kind 0.
fn points(count: usize, generator: &mut Xoshiro256PlusPlus) -> Result<Vec<Disk>, ParameterError> {
    let point = |index: usize| {
        let place = DVec2::new(20.0 * uniform(generator), 10.0 * uniform(generator));
        Ok(Disk::new(place, 1e-3)?.with_kind(Kind::new((index % 3 / 2) as u16)))
    };
    (0..count).map(point).collect()
}

/// Tells whether all values are 1, by chi squared and by four errors each.
fn is_one(values: impl Iterator<Item = (f64, Estimate)>) -> bool {
    let deviations: Vec<f64> =
        values.map(|(_, value)| (value.mean() - 1.0) / value.standard_error()).collect();
    let (chi, free) = (deviations.iter().map(|x| x * x).sum::<f64>(), deviations.len() as f64);
    chi < free + 4.0 * (2.0 * free).sqrt() && deviations.iter().all(|x| x.abs() < 4.5)
}

#[test]
fn points_at_random_places_are_not_correlated() -> Outcome {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(1);
    let both = BOX.with_periodic_sides().with_periodic_ends();
    let corner = Region::new(DVec2::ZERO, DVec2::new(15.0, 3.0));
    let new = || PairCorrelation::new(3.0, 20, times()?);
    let (small, large) = (Kind::new(0), Kind::new(1));
    for (domain, mut correlation) in [
        (both, new()?),
        (both, new()?.between(small, large)),
        (both, new()?.between(large, large)),
        (both, new()?.within(corner)?),
        (BOX.with_periodic_sides(), new()?),
        (BOX, new()?),
    ] {
        for time in 1..500 {
            let disks = points(100, &mut generator)?;
            correlation.on_sample(&Snapshot::new(f64::from(time), &disks, domain, 0.0));
        }
        assert_eq!((correlation.samples(), correlation.range()), (499, 3.0));
        assert!(is_one(correlation.iter()), "{domain:?}: {:?}", correlation.iter().collect::<Vec<_>>());
    }
    Ok(())
}

/// Three points on a line across the periodic side: distances 1, 2 and 3.
#[test]
fn pairs_are_counted_at_the_nearest_image() -> Outcome {
    let domain = BOX.with_periodic_sides().with_periodic_ends();
    let disks = [19.5, 0.5, 2.5].map(|x| Disk::new(DVec2::new(x, 5.0), 0.1));
    let disks = disks.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut correlation = PairCorrelation::new(4.0, 4, times()?)?;
    correlation.on_sample(&Snapshot::new(1.0, &disks, domain, 0.0));
    // Two ordered pairs in each shell, of six; the box has an area of 200.
    let expected = |low: f64| 2.0 * 200.0 / (6.0 * std::f64::consts::PI * (2.0 * low + 1.0));
    for (distance, value) in correlation.iter() {
        let low = distance - 0.5;
        let expected = if low == 0.0 { 0.0 } else { expected(low) };
        assert!((value.mean() - expected).abs() < 1e-12, "{distance}: {}", value.mean());
    }
    Ok(())
}

#[test]
fn runs_in_which_no_pair_can_be_counted_end_with_the_reason() -> Outcome {
    let reason = |container: Container, observer: &mut dyn Observer| {
        let mut run = Simulation::builder(Elastic, container).disks(vec![]).build().unwrap();
        let error = run.run_until(2.0, observer).unwrap_err();
        std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string)
    };
    let mut pairs = PairCorrelation::new(7.0, 3, times()?)?;
    let said = reason(Container::periodic(20.0, 12.0)?, &mut pairs);
    assert!(said.contains("range of the correlation must be at most half of the period, but is 7"), "{said}");
    let said = reason(Container::closed(20.0, 12.0)?, &mut pairs);
    assert!(said.contains("or have a region, but is 7"), "{said}");
    assert!(reason(Container::open(20.0)?, &mut pairs).contains("or have a region, but is 7"));
    let said = reason(Container::open(20.0)?, &mut Stress::new(times()?));
    assert!(said.contains("area of the domain must be finite: choose a region, but is inf"), "{said}");
    Ok(())
}

/// Disks so small that they never meet.
#[test]
fn free_disks_move_by_their_speed() -> Outcome {
    let container = Container::periodic(10.0, 10.0)?;
    let disks = initial::random(&container, 50, 1e-9, 10.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 4.0, 1)?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let squared: f64 = run.disks().iter().map(|disk| disk.velocity().length_squared()).sum::<f64>() / 50.0;
    let mut displacement = MeanSquaredDisplacement::new(SampleTimes::every(0.5)?, 20)?;
    run.run_until(50.0, &mut displacement)?;
    assert_eq!(run.counters().collisions, 0);
    for (time, value) in displacement.iter() {
        let expected = squared * time * time;
        assert!((value.mean() - expected).abs() < 1e-9 * (1.0 + expected), "{time}: {value}");
    }
    // The slope of v²t² from 5 to 10.
    let diffusion = displacement.diffusion_coefficient();
    assert!((diffusion.mean() - squared * 75.0 / 20.0).abs() < 1e-9 * squared);
    assert_eq!(diffusion.samples(), 80);
    Ok(())
}

#[test]
fn a_gap_and_another_number_of_disks_begin_with_new_origins() -> Outcome {
    let domain = BOX.with_periodic_sides();
    let disk = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5);
    let mut displacement = MeanSquaredDisplacement::new(times()?, 3)?;
    for (time, places) in
        [(1.0, vec![1.0]), (2.0, vec![2.0]), (5.0, vec![9.0]), (6.0, vec![9.5]), (7.0, vec![1.0, 2.0])]
    {
        let disks = places.into_iter().map(disk).collect::<Result<Vec<_>, _>>()?;
        displacement.on_sample(&Snapshot::new(time, &disks, domain, 0.0));
    }
    let lags: Vec<(u64, f64)> = displacement.iter().map(|(_, v)| (v.samples(), v.mean())).collect();
    assert_eq!(lags[..2], [(5, 0.0), (2, 0.625)]);
    assert_eq!((lags[2].0, lags[3].0), (0, 0));
    Ok(())
}

/// An autoregressive series, in which each number is 0.8 of the last one and noise.
#[test]
fn an_observable_of_known_memory_has_its_correlation() -> Outcome {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut state = 0.0;
    let series: Vec<f64> = (0..20_000)
        .map(|_| {
            state = 0.8 * state + 0.6 * normal(&mut generator);
            state
        })
        .collect();
    let value = from_fn(|snapshot: &Snapshot<'_>| series[snapshot.time() as usize]);
    let mut correlation = TimeCorrelation::new(value, times()?, 5)?;
    for time in 0..20_000 {
        correlation.on_sample(&Snapshot::new(f64::from(time), &[], BOX, 0.0));
    }
    let fluctuations = granular_edmd::statistics::autocorrelation(&series, 5)?;
    for (lag, ((time, value), normalized)) in (0..).zip(correlation.iter().zip(&fluctuations)) {
        let expected = 0.8_f64.powi(lag);
        assert_eq!(time, f64::from(lag));
        assert!(value.is_converged() && value.standard_error() < 0.03);
        assert!((value.mean() - expected).abs() < 4.0 * value.standard_error(), "{lag}: {value}");
        assert!((normalized.mean() - expected).abs() < 4.0 * value.standard_error(), "{lag}: {normalized}");
    }
    Ok(())
}

/// One collision whose line of centers is cut by the region in halves, and one across the periodic side.
#[test]
fn a_region_gets_its_share_of_a_collision() -> Outcome {
    let domain = BOX.with_periodic_sides();
    let region = Region::new(DVec2::ZERO, DVec2::new(2.0, 10.0));
    let mut stress = Stress::new(times()?).within(region)?;
    stress.on_start(&Moment::new(0.0, 2, 2, domain, 0.0));
    let contact = Contact::new(2.0, 0.5, 0.5, 0.5 / 3.0);
    let at = |x: f64| {
        let impulse = Impulse::new(3.0, 1.0);
        let mut collision = Collision::new(0.5, 0, Partner::Disk(1), contact, impulse);
        (collision.normal, collision.position) = (DVec2::X, DVec2::new(x, 5.0));
        collision
    };
    // From 1.5 to 2.5; from 19.25 to 20.25, of which a quarter is beyond the side; and outside.
    for x in [2.5, 20.25, 10.0] {
        stress.on_collision(&at(x));
    }
    stress.on_sample(&Snapshot::new(1.0, &[], domain, 0.0));
    let tensor = stress.collisional();
    let (xx, yx) = (tensor.xx.mean(), tensor.yx.mean());
    assert!((xx - 3.0 * 0.75 / 20.0).abs() < 1e-15 && (yx - 0.75 / 20.0).abs() < 1e-15, "{tensor:?}");
    assert_eq!((tensor.xy.mean(), tensor.yy.mean(), stress.samples()), (0.0, 0.0, 1));
    Ok(())
}

/// A ball between walls, in a run of one piece and in pieces that cut the intervals.
#[test]
fn a_run_in_pieces_has_the_stress_of_a_run_in_one() -> Outcome {
    let container = Container::closed(5.0, 3.0)?;
    let floor = container.index(Wall::Floor).unwrap();
    let ball = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::new(0.3, 3.0))?;
    let measured = |ends: &[f64]| -> Result<_, Box<dyn std::error::Error>> {
        let mut run = Simulation::builder(Elastic, container.clone()).disks(vec![ball]).build()?;
        let walls = WallStress::new(times()?).with_wall(floor, 5.0)?;
        let mut watched = (walls, Stress::new(times()?));
        run.run_until(0.4, &mut ())?;
        for &end in ends {
            run.run_until(end, &mut watched)?;
        }
        Ok(watched)
    };
    let whole = measured(&[10.0])?;
    let pieces = measured(&[1.7, 3.0, 3.1, 10.0])?;
    assert_eq!(whole.0.pressure(floor), pieces.0.pressure(floor));
    assert_eq!(whole.1.tensor(), pieces.1.tensor());
    // The interval in which the run began is a part of one, which does not count.
    assert_eq!(whole.1.samples(), 9);
    assert_eq!(whole.0.pressure(floor + 1), None);
    Ok(())
}

#[test]
fn flow_is_no_temperature_on_a_grid() -> Outcome {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
    let region = Region::new(DVec2::ZERO, DVec2::new(20.0, 10.0));
    let disks = points(40_000, &mut generator)?;
    let flows: [fn(DVec2) -> DVec2; 2] =
        [|place| DVec2::new(0.5 * place.y, 0.0), |place| 0.5 * (place - DVec2::new(10.0, 5.0)).perp()];
    for (flow, both) in flows.into_iter().zip([false, true]) {
        let moving = |disk: &Disk| disk.with_velocity(flow(disk.position()));
        let moving = disks.iter().map(moving).collect::<Result<Vec<_>, _>>()?;
        let snapshot = Snapshot::new(0.0, &moving, BOX, 0.0);
        assert!(Temperatures.measure(&snapshot).horizontal > 2.0);
        let about = |columns, rows| {
            Ok::<_, ParameterError>(
                TemperaturesAboutFlow::new(Grid::new(region, columns, rows)?).measure(&snapshot),
            )
        };
        // What is left is the flow within a cell of side 1 and of 1/5: m γ²h²/12. The mean square of 4e4
        // uniform numbers is known to 0.9/√4e4, half of a per cent.
        let left = 0.25 / 12.0;
        let (coarse, fine) = (about(20, 10)?, about(100, 50)?);
        assert!((coarse.horizontal / left - 1.0).abs() < 0.03, "{coarse:?}");
        assert!((fine.horizontal / left - 0.04).abs() < 0.002, "{fine:?}");
        assert_eq!(coarse.vertical > 0.0, both);
        assert!(!both || (coarse.vertical / left - 1.0).abs() < 0.03, "{coarse:?}");
    }
    // A gas at rest has the same temperature on any grid.
    let gas = initial::with_maxwellian_velocities(disks, 2.0, 5)?;
    let snapshot = Snapshot::new(0.0, &gas, BOX, 0.0);
    for (columns, rows) in [(1, 1), (20, 10), (100, 100)] {
        let grid = Grid::new(region, columns, rows)?;
        let temperature = TemperaturesAboutFlow::new(grid).measure(&snapshot);
        // There are 4e4 - 1e4 degrees of freedom in each direction, or more: 0.8 %.
        assert!((temperature.horizontal / 2.0 - 1.0).abs() < 0.03, "{columns}: {temperature:?}");
        assert!((temperature.translational() / 2.0 - 1.0).abs() < 0.02, "{columns}: {temperature:?}");
    }
    Ok(())
}

/// A Maxwellian gas of two masses in a swirl: only about the flow are all cumulants zero.
#[test]
fn velocities_about_a_flow_are_those_of_the_gas_in_it() -> Outcome {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(4);
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(20.0, 10.0)), 10, 5)?;
    let new = || VelocityDistribution::new(4.0, 20, times()?);
    let mut distributions = [new()?, new()?.about_mean(), new()?.about_flow(grid)];
    for time in 0..400 {
        let disk = |disk: Disk| {
            let mass = 1.0 + 3.0 * f64::from(disk.kind().number());
            // One velocity for each cell, as the swirl has it at its middle.
            let cell = (disk.position() / 2.0).floor() * 2.0 + DVec2::ONE;
            let noise = DVec2::new(gauss(&mut generator), gauss(&mut generator)) / mass.sqrt();
            disk.with_mass(mass)?.with_velocity(noise + (cell - DVec2::new(10.0, 5.0)).perp())
        };
        let disks = points(200, &mut Xoshiro256PlusPlus::seed_from_u64(time + 10))?;
        let disks = disks.into_iter().map(disk).collect::<Result<Vec<_>, _>>()?;
        let snapshot = Snapshot::new(time as f64, &disks, BOX, 0.0);
        for distribution in &mut distributions {
            distribution.on_sample(&snapshot);
        }
    }
    let [all, about_mean, about_flow] = &distributions;
    for estimate in [about_flow.second_cumulant(), about_flow.third_cumulant()]
        .into_iter()
        .chain(about_flow.excess_kurtosis())
    {
        assert!(estimate.mean().abs() < 4.0 * estimate.standard_error(), "{estimate}");
    }
    for swirling in [all, about_mean] {
        assert!(swirling.second_cumulant().mean().abs() > 0.1, "{}", swirling.second_cumulant());
    }
    assert_eq!(about_flow.speed().count(), 80_000);
    assert_eq!(about_flow.horizontal().count(), about_flow.vertical().count());
    Ok(())
}

/// A normal variable, exactly (Box and Muller).
fn gauss(generator: &mut Xoshiro256PlusPlus) -> f64 {
    let radius = (-2.0 * (1.0 - uniform(generator)).ln()).sqrt();
    radius * (std::f64::consts::TAU * uniform(generator)).cos()
}

#[test]
fn a_histogram_counts_what_is_inside_and_outside() -> Outcome {
    let mut histogram = Histogram::new(-1.0, 1.0, 4)?;
    histogram.extend([-1.0, -0.5, 0.0, 0.999, 1.0, -1.1, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]);
    assert_eq!(histogram.bins().map(|bin| bin.count).collect::<Vec<_>>(), [1, 1, 1, 1]);
    assert_eq!((histogram.count(), histogram.below(), histogram.above()), (8, 2, 2));
    let bin = histogram.bins().nth(1).unwrap();
    assert_eq!((bin.low, bin.high, bin.density), (-0.5, 0.0, 0.25));
    assert_eq!(bin.standard_error, (0.125_f64 * 0.875 / 8.0).sqrt() / 0.5);
    histogram.clear();
    assert!(histogram.bins().all(|bin| bin.count == 0 && bin.density.is_nan()));
    Ok(())
}

#[test]
fn a_wall_has_histograms_of_its_own() -> Outcome {
    let mut histograms = CollisionHistograms::new(4.0, 4.0, 4)?.with_wall(1);
    let contact = Contact::new(1.5, -1.5, 1.0, 1.0 / 3.0);
    for partner in [Partner::Disk(1), Partner::Wall(0), Partner::Wall(1)] {
        histograms.on_collision(&Collision::new(0.5, 0, partner, contact, Impulse::new(3.0, 0.0)));
    }
    let counts = |histogram: &Histogram| histogram.bins().map(|bin| bin.count).collect::<Vec<_>>();
    assert_eq!(counts(histograms.obliqueness()), [1, 0, 0, 0]);
    assert_eq!(counts(histograms.closing_speed()), [0, 1, 0, 0]);
    assert_eq!(counts(histograms.impulse()), [0, 0, 0, 1]);
    Ok(())
}

#[test]
fn parameters_that_measure_nothing_are_refused() -> Outcome {
    let times = times()?;
    let nowhere = Region::new(DVec2::ONE, DVec2::ONE);
    assert!(PairCorrelation::new(0.0, 1, times).is_err());
    assert!(PairCorrelation::new(f64::INFINITY, 1, times).is_err());
    assert!(PairCorrelation::new(1.0, 0, times).is_err());
    assert!(PairCorrelation::new(1.0, 1, times)?.within(nowhere).is_err());
    assert!(Stress::new(times).within(nowhere).is_err());
    assert!(WallStress::new(times).with_wall(0, 0.0).is_err());
    for lags in [0, usize::MAX] {
        assert!(MeanSquaredDisplacement::new(times, lags).is_err());
        assert!(TimeCorrelation::new(Velocities, times, lags).is_err());
    }
    assert!(VelocityDistribution::new(-1.0, 10, times).is_err());
    assert!(CollisionHistograms::new(1.0, f64::NAN, 10).is_err());
    assert!(granular_edmd::statistics::autocorrelation(&[1.0, 2.0, 4.0], 2).is_err());
    Ok(())
}
