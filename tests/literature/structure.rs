//! Pair correlations of elastic disks, against the values at contact that follow from their pressure.

use granular_edmd::boundary::Region;
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{PairCorrelation, SampleTimes, Sampled};

use crate::gas::{collision_rate, contact_value, periodic_gas, run_for};
use crate::mixtures::{LARGE, Mixture, SMALL, Species};
use crate::{Outcome, agrees};

/// Returns the correlation at contact: a parabola through the 20 bins beyond it, carried on to the contact.
fn at_contact(correlation: &PairCorrelation, contact: f64) -> f64 {
    let beyond = correlation.iter().filter(|(distance, _)| *distance > contact).take(20);
    let points: Vec<(f64, f64)> =
        beyond.map(|(distance, value)| (distance - contact, value.mean())).collect();
    let power = |order: i32| points.iter().map(|(x, _)| x.powi(order)).sum::<f64>();
    let moment = |order: i32| points.iter().map(|(x, y)| x.powi(order) * y).sum::<f64>();
    // The constant of the least squares, by Cramer's rule.
    let determinant = |[a, b, c]: [[f64; 3]; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let rows = [0, 1, 2].map(|row| [power(row), power(row + 1), power(row + 2)]);
    let moments = [0, 1, 2].map(moment);
    let constants = [0, 1, 2].map(|row: usize| [moments[row], rows[row][1], rows[row][2]]);
    determinant(constants) / determinant(rows)
}

#[test]
fn the_pair_correlation_at_contact_is_that_of_the_pressure() -> Outcome {
    for packing in [0.1, 0.3] {
        let mut gas = periodic_gas(1000, packing, Elastic, 1)?;
        let interval = 1.0 / collision_rate(packing);
        let mut correlation = Sampled::new(PairCorrelation::new(2.0, 100)?, SampleTimes::every(interval)?);
        gas.run_until(gas.time() + 400.5 * interval, &mut correlation)?;
        assert!(correlation.iter().take(50).all(|(_, value)| value.mean() == 0.0), "disks overlap");
        // Each bin holds 6000 pairs or more: 1.3 %. The constant of a parabola through 20 of them has three
        // times the error of their mean: 0.9 %. The curvature beyond the parabola adds 0.5 %.
        let measured = at_contact(&correlation, 1.0);
        assert!(agrees(&format!("g at contact, {packing}"), measured, contact_value(packing), 0.03));
    }
    Ok(())
}

#[test]
fn far_pairs_are_not_correlated() -> Outcome {
    let mut gas = periodic_gas(1000, 0.1, Elastic, 2)?;
    let times = SampleTimes::every(1.0 / collision_rate(0.1))?;
    let mut correlation = Sampled::new(PairCorrelation::new(10.0, 20)?, times);
    gas.run_until(gas.time() + 400.0 * times.interval(), &mut correlation)?;
    // Beyond 5 diameters, g - 1 is below 1e-3 at this density, in a box of fixed number up to 1/N.
    for (distance, value) in correlation.iter().filter(|(distance, _)| *distance > 5.0) {
        let (mean, error) = (value.mean(), value.standard_error());
        assert!(error < 4e-3 && (mean - 1.0).abs() < 4.0 * error + 2e-3, "{distance}: {value}");
    }
    Ok(())
}

/// Around the disks of a small part of the box, pairs are those of the whole box.
#[test]
fn a_part_of_the_box_has_the_correlation_of_the_whole() -> Outcome {
    let mut gas = periodic_gas(1000, 0.3, Elastic, 3)?;
    let times = SampleTimes::every(1.0 / collision_rate(0.3))?;
    let part = Region::new(DVec2::splat(10.0), DVec2::splat(14.0));
    let mut whole = Sampled::new(PairCorrelation::new(3.0, 6)?, times);
    let mut around = Sampled::new(PairCorrelation::new(3.0, 6)?.within(part)?, times);
    gas.run_until(gas.time() + 1000.0 * times.interval(), &mut (&mut whole, &mut around))?;
    // The part holds 6 disks on average, so each bin has some 3e4 pairs; blocks of correlated samples and the
    // scatter of the number of disks leave 2 %.
    for ((distance, whole), (_, part)) in whole.iter().zip(around.iter()).skip(2) {
        let off = part.mean() / whole.mean() - 1.0;
        assert!(off.abs() < 0.08, "{distance}: {part}, not {whole}");
    }
    Ok(())
}

/// Three pairs of kinds, against the values of Jenkins and Mancini.
#[test]
fn a_mixture_has_three_pair_correlations() -> Outcome {
    let species = |count, radius| Species { count, radius, mass: 1.0 };
    let mixture = Mixture { species: [species(800, 0.5), species(200, 1.0)], packing_fraction: 0.25 };
    let mut run = mixture.simulation(Elastic, 1)?;
    run_for(&mut run, 20.0, &mut ())?;
    let times = SampleTimes::every(1.0)?;
    let correlation =
        |first, second| Ok(Sampled::new(PairCorrelation::new(3.0, 120)?.between(first, second), times));
    let correlations: Result<Vec<_>, granular_edmd::ParameterError> =
        [(SMALL, SMALL), (SMALL, LARGE), (LARGE, LARGE)]
            .map(|(i, j)| correlation(i, j))
            .into_iter()
            .collect();
    let mut correlations = correlations?;
    run.run_until(run.time() + 600.0, &mut correlations)?;
    // The large pairs are fewest: some 1500 in a bin, 2.6 %, so 1.8 % at contact.
    for (measured, (i, j, contact)) in correlations.iter().zip([(0, 0, 1.0), (0, 1, 1.5), (1, 1, 2.0)]) {
        let what = format!("g at contact, kinds {i} and {j}");
        assert!(agrees(&what, at_contact(measured, contact), mixture.correlation(i, j), 0.06));
    }
    Ok(())
}
