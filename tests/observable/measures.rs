//! Pairs, displacements and correlations in time of known states and of chance.

use granular_edmd::boundary::{Boundary, Container, Region};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Accumulator, CollisionHistograms, MeanSquaredDisplacement, Observer, PairCorrelation, SampleTimes,
    Sampled, Snapshot, Stress, TimeCorrelation, Velocities, VelocityDistribution, WallStress, measured_by,
};
use granular_edmd::statistics::Estimate;
use granular_edmd::{Disk, Kind, ParameterError, Simulation, initial};

use crate::chance::{BOX, Chance, points};

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn times() -> Result<SampleTimes, ParameterError> {
    SampleTimes::every(1.0)
}

/// Returns whether all values are 1, by chi squared and within four errors each.
fn is_one(values: impl Iterator<Item = (f64, Estimate)>) -> bool {
    let deviations: Vec<f64> =
        values.map(|(_, value)| (value.mean() - 1.0) / value.standard_error()).collect();
    let (chi, free) = (deviations.iter().map(|x| x * x).sum::<f64>(), deviations.len() as f64);
    chi < free + 4.0 * (2.0 * free).sqrt() && deviations.iter().all(|x| x.abs() < 4.5)
}

#[test]
fn points_at_random_places_are_not_correlated() -> Outcome {
    let mut chance = Chance::new(1);
    let both = BOX.with_periodic_sides().with_periodic_ends();
    let corner = Region::new(DVec2::ZERO, DVec2::new(15.0, 3.0));
    let new = || PairCorrelation::new(3.0, 20);
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
            let disks = points(100, &mut chance)?;
            correlation.add(&Snapshot::new(f64::from(time), &disks, domain, 0.0)).unwrap();
        }
        assert!(correlation.iter().all(|(_, value)| value.samples() == 499));
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
    let mut correlation = Sampled::new(PairCorrelation::new(4.0, 4)?, times()?);
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
    let mut pairs = Sampled::new(PairCorrelation::new(7.0, 3)?, times()?);
    let said = reason(Container::periodic(20.0, 12.0)?, &mut pairs);
    assert!(said.contains("range of the correlation must be at most half of the period, but is 7"), "{said}");
    let said = reason(Container::closed(20.0, 12.0)?, &mut pairs);
    assert!(said.contains("unless a region is given, but is 7"), "{said}");
    assert!(reason(Container::open(20.0)?, &mut pairs).contains("unless a region is given, but is 7"));
    let moment = Snapshot::new(0.0, &[], Container::periodic(20.0, 20.0)?.domain(), 0.0).with_wall_count(5);
    let said = PairCorrelation::new(1.0, 3)?.check(&moment).unwrap_err().to_string();
    assert!(said.contains("range of the correlation must be less than the distance of the region"), "{said}");
    let large = Region::new(DVec2::new(-1.0, 0.0), DVec2::new(5.0, 5.0));
    let said = reason(
        Container::closed(20.0, 12.0)?,
        &mut Sampled::new(PairCorrelation::new(1.0, 3)?.within(large)?, times()?),
    );
    assert!(said.contains("edge of the region must be inside the domain, but is -1"), "{said}");
    let said = reason(Container::closed(20.0, 12.0)?, &mut Stress::new(times()?).within(large)?);
    assert!(said.contains("edge of the region must be inside the domain, but is -1"), "{said}");
    let mut walls = WallStress::new(times()?).with_wall("lid", 5.0)?.with_wall("ceiling", 5.0)?;
    let said = reason(Container::closed(20.0, 12.0)?, &mut walls);
    assert!(said.contains(
            "number of walls named \"ceiling\" must be at least 1 (the boundary has \"floor\", \"left\", \"right\", \"lid\"), but is 0"
        ), "{said}");
    let said = reason(Container::open(20.0)?, &mut Stress::new(times()?));
    assert!(said.contains("area of the domain must be finite: choose a region, but is inf"), "{said}");
    Ok(())
}

/// Disks so small that they never meet.
#[test]
fn free_disks_move_by_their_speed() -> Outcome {
    let container = Container::periodic(10.0, 10.0)?;
    let disks = initial::scattered(&container, 50, 1e-9, 10.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 4.0, 1)?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let squared: f64 = run.disks().iter().map(|disk| disk.velocity().length_squared()).sum::<f64>() / 50.0;
    let mut displacement = MeanSquaredDisplacement::new(20, SampleTimes::every(0.5)?)?;
    run.run_until(50.0, &mut displacement)?;
    assert_eq!(run.counters().disk_collisions, 0);
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

/// At late times, an interval of the clock is smaller than a billionth of the time.
#[test]
fn a_late_gap_is_a_gap() -> Outcome {
    let disk = Disk::new(DVec2::splat(2.0), 0.5)?.with_velocity(DVec2::new(3.0, 4.0))?;
    for (start, interval) in [(0.0, 1e-3), (1e6, 1e-3), (1e7, 1e-2), (1e9, 1e-5)] {
        let container = Container::periodic(8.0, 8.0)?;
        let mut run = Simulation::builder(Elastic, container).disks([disk]).starting_at(start).build()?;
        let mut squared = MeanSquaredDisplacement::new(2, SampleTimes::every(interval)?)?;
        let at = |k: u32| start + f64::from(k) * interval;
        for k in 0..50 {
            run.run_until(at(3 * k + 1), &mut squared)?;
            run.run_until(at(3 * k + 2) - 0.01 * interval, &mut ())?;
            run.run_until(at(3 * k + 3), &mut squared)?;
        }
        let (_, lag) = squared.iter().nth(1).ok_or("no lag")?;
        assert!((lag.mean() / (25.0 * interval * interval) - 1.0).abs() < 0.05, "{start}: {lag}");
    }
    Ok(())
}

#[test]
fn a_gap_and_other_disks_begin_with_new_origins() -> Outcome {
    let domain = BOX.with_periodic_sides();
    let disk = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5);
    let mut displacement = MeanSquaredDisplacement::new(3, times()?)?;
    for (time, places) in
        [(1.0, vec![1.0]), (2.0, vec![2.0]), (5.0, vec![9.0]), (6.0, vec![9.5]), (7.0, vec![1.0, 2.0])]
    {
        let first = if places.len() > 1 { 2 } else { 1 };
        let disks = places.into_iter().zip(first..).map(|(x, id)| disk(x)?.with_id(id));
        let disks = disks.collect::<Result<Vec<_>, _>>()?;
        displacement.on_sample(&Snapshot::new(time, &disks, domain, 0.0));
    }
    let lags: Vec<(u64, f64)> = displacement.iter().map(|(_, v)| (v.samples(), v.mean())).collect();
    assert_eq!(lags[..2], [(5, 0.0), (2, 0.625)]);
    assert_eq!((lags[2].0, lags[3].0), (0, 0));
    Ok(())
}

/// An autoregressive series, in which each number is 0.8 times the last one plus noise.
#[test]
fn an_observable_of_known_memory_has_its_correlation() -> Outcome {
    let mut chance = Chance::new(2);
    let mut state = 0.0;
    let series: Vec<f64> = (0..20_000)
        .map(|_| {
            state = 0.8 * state + 0.6 * chance.normal();
            state
        })
        .collect();
    let value = measured_by(|snapshot: &Snapshot<'_>| series[snapshot.time() as usize]);
    let mut correlation = TimeCorrelation::new(value, 5, times()?)?;
    for time in 0..20_000 {
        correlation.on_sample(&Snapshot::new(f64::from(time), &[], BOX, 0.0));
    }
    for (lag, (time, value)) in (0..).zip(correlation.iter()) {
        let expected = 0.8_f64.powi(lag);
        assert_eq!(time, f64::from(lag));
        assert!(value.is_converged() && value.standard_error() < 0.03);
        assert!((value.mean() - expected).abs() < 4.0 * value.standard_error(), "{lag}: {value}");
    }
    Ok(())
}

#[test]
fn parameters_that_measure_nothing_are_refused() -> Outcome {
    let times = times()?;
    let nowhere = Region::new(DVec2::ONE, DVec2::ONE);
    assert!(PairCorrelation::new(0.0, 1).is_err());
    assert!(PairCorrelation::new(f64::INFINITY, 1).is_err());
    assert!(PairCorrelation::new(1.0, 0).is_err());
    assert!(PairCorrelation::new(1.0, 1)?.within(nowhere).is_err());
    assert!(Stress::new(times).within(nowhere).is_err());
    assert!(WallStress::new(times).with_wall("floor", 0.0).is_err());
    for lags in [0, usize::MAX] {
        assert!(MeanSquaredDisplacement::new(lags, times).is_err());
        assert!(TimeCorrelation::new(Velocities, lags, times).is_err());
    }
    assert!(VelocityDistribution::new(-1.0, 10).is_err());
    assert!(CollisionHistograms::new(1.0, f64::NAN, 10).is_err());
    Ok(())
}
