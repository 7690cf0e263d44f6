//! Samples, kicks and insertions at the end of a run, however the end is rounded; runs of some collisions.

use granular_edmd::observable::{ByCollisions, Temperatures};
use granular_edmd::prelude::*;
use granular_edmd::simulation::{Driving, Inlet, Rescaling, RunEnd};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// The ends 0.1, 0.2, 0.3, … as a user writes them, and as a program computes them.
#[test]
fn no_decimal_end_is_missed() -> Outcome {
    let disk = Disk::new(DVec2::ONE, 0.5)?.with_velocity(DVec2::new(0.3, 0.1))?;
    let start = Simulation::builder(Elastic, Container::closed(5.0, 5.0)?).disks([disk]).build()?;
    for interval in [0.1, 0.2, 0.05, 0.3, 0.7] {
        let mut pieces = start.clone();
        let mut in_pieces = Series::new(CenterOfMass, SampleTimes::every(interval)?);
        for count in 1..=1000_u32 {
            let written: f64 = format!("{:.2}", f64::from(count) * interval).parse()?;
            pieces.run_until(written, &mut in_pieces)?;
            assert_eq!(in_pieces.times().len(), count as usize, "every {interval} until {written}");
            assert_eq!(in_pieces.times().last(), Some(&written));
            if count % 50 == 0 {
                for end in [written, f64::from(count) * interval, (f64::from(count) * interval).next_down()] {
                    let mut whole = Series::new(CenterOfMass, SampleTimes::every(interval)?);
                    start.clone().run_until(end, &mut whole)?;
                    assert_eq!(whole.times(), in_pieces.times(), "every {interval} until {end:?}");
                    assert_eq!(whole.values(), in_pieces.values(), "every {interval} until {end:?}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn kicks_and_insertions_at_the_end_belong_to_the_run() -> Outcome {
    for end in [0.3, 0.3_f64.next_down(), 0.1 + 0.2] {
        let disks = [1.0, 3.0].map(|x| Disk::new(DVec2::new(x, 1.0), 0.5).unwrap());
        let disks = initial::with_maxwellian_velocities(disks.to_vec(), 1.0, 1)?;
        let mut run = Simulation::builder(Elastic, Container::closed(50.0, 50.0)?).disks(disks).build()?;
        let model = Disk::new(DVec2::ZERO, 0.1)?;
        let places = [DVec2::new(10.0, 10.0), DVec2::new(40.0, 40.0)];
        run.add_inlet(Inlet::new(places, [model], SampleTimes::every(0.1)?, 1)?)?;
        let mut rescaling = Rescaling::new(1.0, SampleTimes::every(0.1)?)?;
        run.run_driven(&Limits::until(end), &mut rescaling, &mut ())?;
        assert_eq!(run.counters().insertions, 3);
        assert_eq!(rescaling.times().upcoming(), 0.4);
        // The next run begins after the third time, and repeats nothing.
        run.run_driven(&Limits::until(0.35), &mut rescaling, &mut ())?;
        assert_eq!((run.counters().insertions, rescaling.times().upcoming()), (3, 0.4));
    }
    Ok(())
}

#[test]
fn times_at_equal_ratios_follow_a_cooling_gas() -> Outcome {
    let mut run = gas(0.8)?;
    let mut series = Series::new(Temperatures, SampleTimes::at_ratio(0.1, 10.0)?);
    run.run_until(50.0, &mut series)?;
    run.run_until(1000.0, &mut series)?;
    let expected = [0.1, 1.0, 10.0, 100.0, 1000.0];
    assert_eq!(series.times().len(), expected.len(), "{:?}", series.times());
    assert!(
        series.times().iter().zip(expected).all(|(time, expected)| (time / expected - 1.0).abs() < 1e-14)
    );
    // Ten samples a decade end at the end of a decade, though rounding moves the last ones.
    for (first, of_decade) in [(0.1, 10.0), (0.01, 10.0), (1.0, 10.0), (0.1, 5.0), (0.1, 3.0)] {
        let mut series =
            Series::new(Temperatures, SampleTimes::at_ratio(first, 10_f64.powf(1.0 / of_decade))?);
        gas(0.8)?.run_until(100.0, &mut series)?;
        assert_eq!(series.times().len() as f64, of_decade * libm::log10(100.0 / first).round() + 1.0);
    }
    assert!(SampleTimes::at_ratio(0.0, 2.0).is_err() && SampleTimes::at_ratio(1.0, 1.0).is_err());
    Ok(())
}

/// Several observers, each with its own number of collisions, in a run that is cut anywhere.
#[test]
fn samples_come_by_collisions() -> Outcome {
    let series = |count| ByCollisions::new(count, Series::new(Temperatures, SampleTimes::every(1.0)?));
    let (mut whole, mut run) = ((series(100)?, series(30)?), gas(0.8)?);
    assert_eq!(run.run(&Limits::collisions(3000), &mut whole)?, RunEnd::Collisions);
    assert_eq!(run.counters().collisions(), 3000);
    assert_eq!([&whole.0, &whole.1].map(|by| by.inner().values().len()), [30, 100]);
    let (mut pieces, mut run) = ((series(100)?, series(30)?), gas(0.8)?);
    for _ in 0..40 {
        run.run(&Limits::collisions(75), &mut pieces)?;
    }
    assert_eq!(pieces.0.inner().times(), whole.0.inner().times());
    assert_eq!(pieces.1.inner().values(), whole.1.inner().values());
    Ok(())
}

/// A run without an end stays where its last event was.
#[test]
fn a_run_in_which_nothing_happens_ends() -> Outcome {
    let disk = Disk::new(DVec2::ONE, 0.5)?;
    let mut run = Simulation::builder(Elastic, Container::closed(5.0, 5.0)?).disks([disk]).build()?;
    assert_eq!(run.run(&Limits::collisions(10), &mut ())?, RunEnd::Time);
    assert_eq!(run.time(), 0.0);
    run.run_until(1.0, &mut ())?;
    assert_eq!(run.disks()[0].position(), disk.position());
    Ok(())
}

fn gas(restitution: f64) -> Outcome<Simulation<Smooth>> {
    let container = Container::periodic(20.0, 20.0)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 1.0, 1)?;
    let disks = initial::without_drift(disks)?;
    Ok(Simulation::builder(Smooth::from_restitution(restitution)?, container).disks(disks).build()?)
}
