//! Promises of the Monte Carlo average beyond physics: its bits, its stopping, its input.

use granular_edmd::collision::{Contact, ContactDuration, Frictional, Impulse, Smooth, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::{DirectSimulation, IsoLine, Maxwellian, MonteCarlo, effective_inelasticity};
use granular_edmd::{Disk, ParameterError, initial};

type Outcome = Result<(), ParameterError>;

/// The same with and without the feature `rayon`, which both runs of this test check.
/// A change of these bits must be announced.
#[test]
fn average_keeps_its_bits() -> Outcome {
    let (rule, gas) = (Frictional::from_inelasticity(0.1, 0.1, 0.3)?, Maxwellian::new(1.0)?);
    let estimate = MonteCarlo::new(2005).with_samples(100_000).mean_energy_change(&rule, &gas);
    let bits = [estimate.mean(), estimate.standard_error()].map(f64::to_bits);
    assert_eq!(bits, [13_828_018_993_154_353_492, 4_543_477_598_112_959_443], "{estimate:?}");
    assert_eq!(estimate.samples(), 102_400);
    Ok(())
}

#[cfg(feature = "rayon")]
#[test]
fn average_does_not_depend_on_the_number_of_threads() -> Outcome {
    let (rule, gas) = (Frictional::from_inelasticity(0.02, 0.02, 0.5)?, Maxwellian::new(1.0)?);
    let average = MonteCarlo::new(1).with_samples(300_000).with_standard_error(1e-9)?;
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| average.mean_energy_change(&rule, &gas))
    };
    assert_eq!(on(1), on(2));
    assert_eq!(on(1), on(5));
    Ok(())
}

#[test]
fn average_stops_at_the_wanted_error_or_the_last_sample() -> Outcome {
    let (rule, gas) = (Frictional::from_inelasticity(0.1, 0.1, 0.3)?, Maxwellian::new(1.0)?);
    let average = MonteCarlo::new(1);
    let loose = average.with_standard_error(1e-2)?.mean_energy_change(&rule, &gas);
    assert_eq!(loose.samples(), 1 << 16);
    let tight = average.with_standard_error(3e-5)?.mean_energy_change(&rule, &gas);
    assert!(tight.standard_error() <= 3e-5 && tight.samples() > loose.samples());
    let short = average.with_standard_error(1e-12)?.with_samples(1 << 17).mean_energy_change(&rule, &gas);
    assert!(short.standard_error() > 1e-12 && short.samples() == 1 << 17);
    assert_eq!(average.with_samples(0).mean_energy_change(&rule, &gas).samples(), 4096);
    Ok(())
}

#[test]
fn seeds_differ() -> Outcome {
    let (rule, gas) = (Frictional::from_inelasticity(0.1, 0.1, 0.3)?, Maxwellian::new(1.0)?);
    let [one, other] =
        [1, 2].map(|seed| MonteCarlo::new(seed).with_samples(1).mean_energy_change(&rule, &gas));
    assert_ne!(one.mean(), other.mean());
    Ok(())
}

/// A rule that fails shows in the mean, and does not keep the average from ending.
#[test]
fn not_a_number_is_not_hidden() -> Outcome {
    let broken = from_fn(|_: &Contact| Impulse::new(f64::NAN, 0.0));
    let average = MonteCarlo::new(1).with_samples(1).with_standard_error(1e-3)?;
    assert!(average.mean_energy_change(&broken, &Maxwellian::new(1.0)?).mean().is_nan());
    Ok(())
}

/// A rule that loses energy in one collision of millions, none of which is drawn.
#[test]
fn losses_that_were_not_drawn_are_not_excluded() -> Outcome {
    let rare = from_fn(|contact: &Contact| {
        Impulse::new(contact.normal_impulse(if contact.closing_speed() < 9.0 { 1.0 } else { 0.0 }), 0.0)
    });
    let change = MonteCarlo::new(1).with_samples(1).mean_energy_change(&rare, &Maxwellian::new(1.0)?);
    assert_eq!((change.mean(), change.standard_error()), (0.0, 0.0));
    assert!(!change.is_converged(), "{change}");
    Ok(())
}

/// Around the friction of the largest loss, friction alone loses more than this line does.
#[test]
fn a_line_has_its_gap_on_any_grid() -> Outcome {
    let line = IsoLine::new(-0.3431, &Maxwellian::new(1.0)?)?;
    for steps in [10_u32, 20, 40, 100, 1000] {
        let frictions: Vec<f64> = (0..=steps).map(|step| f64::from(step) / f64::from(steps)).collect();
        let pieces = line.trace(&frictions, 0.5)?;
        let [before, after] = &pieces[..] else { panic!("{steps}: {} pieces", pieces.len()) };
        let gap = [before.last(), after.first()].map(|end| end.map_or(f64::NAN, |end| end.0));
        assert!((gap[0] - 0.258_4).abs() < 1e-4 && (gap[1] - 0.267_1).abs() < 1e-4, "{steps}: {gap:?}");
    }
    Ok(())
}

#[test]
fn parameters_without_a_meaning_are_refused() -> Outcome {
    let gas = Maxwellian::new(1.0)?;
    for bad in [0.0, -1.0, 1e31, f64::NAN, f64::INFINITY] {
        assert!(Maxwellian::new(bad).is_err(), "{bad}");
    }
    for bad in [-1.0, 1e31, f64::NAN] {
        assert!(gas.with_rotational_temperature(bad).is_err(), "{bad}");
        assert!(MonteCarlo::new(1).with_standard_error(bad.min(0.0)).is_err(), "{bad}");
    }
    for bad in [0.1, f64::NAN, f64::NEG_INFINITY] {
        assert!(IsoLine::new(bad, &gas).is_err() && effective_inelasticity(bad, 1.0).is_err(), "{bad}");
    }
    let line = IsoLine::new(-0.1, &gas)?;
    assert!(line.inelasticities(-0.1).is_err() && line.inelasticities(f64::INFINITY).is_err());
    assert!(line.trace(&[0.1, f64::NAN], 0.2).is_err() && line.trace(&[0.1], 0.6).is_err());
    assert_eq!(line.trace(&[0.2, 0.1], 0.2).unwrap_err().name(), "friction");
    assert_eq!(line.trace(&[], 0.2)?, Vec::<Vec<(f64, f64)>>::new());
    Ok(())
}

/// A direct simulation knows when its disks last collided: with a contact duration longer than the run, only
/// the first collision of two disks loses energy.
#[test]
fn direct_simulation_knows_the_contact_duration() -> Outcome {
    let disks = vec![Disk::new(DVec2::ZERO, 0.5)?; 100];
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let rule = ContactDuration::new(Smooth::from_restitution(0.9)?, 1e9)?;
    let mut gas = DirectSimulation::new(rule, disks, 0.1, 1)?;
    let energy = |gas: &DirectSimulation<_>| gas.disks().iter().map(Disk::translational_energy).sum::<f64>();
    let start = energy(&gas);
    gas.run_until(50.0)?;
    let late = energy(&gas);
    gas.run_until(100.0)?;
    assert!(late < 0.99 * start && (energy(&gas) / late - 1.0).abs() < 1e-12, "{start}, {late}");
    Ok(())
}
