//! The command `bench`: the core hours of a plan.

use std::path::Path;
use std::time::Duration;

use granular_edmd::simulation::Limits;
use granular_edmd::speed::Meter;

use super::terminal::{read, say};
use super::{End, Failure, Plan, StudyError, core_time};
use crate::Experiment;

/// Largest number of ramps whose first values are run in order to estimate the core hours of a plan.
const RAMPS: usize = 4;

/// Prints the core hours of a plan, estimated from short runs of the first values of some ramps.
pub(super) fn plan<E: Experiment>(path: &Path, json: bool, quick: bool) -> Result<End, Failure> {
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
    let (ramps, share) = (plan.ramp_count(), Duration::from_millis(if quick { 200 } else { 2000 }));
    let chosen: Vec<usize> = (0..ramps.min(RAMPS)).map(|k| k * ramps / ramps.min(RAMPS)).collect();
    let hours =
        chosen.iter().map(|&ramp| hours(&plan, ramp, share)).collect::<Result<Vec<f64>, Failure>>()?;
    let values = (ramps * plan.value_count()) as f64;
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|of| values * hours.iter().copied().reduce(of).unwrap_or(0.0));
    let mean = values * hours.iter().sum::<f64>() / hours.len() as f64;
    say(&if json {
        format!(r#"{{"core_hours":{mean},"least":{least},"most":{most},"values":{values}}}"#)
    } else {
        let [mean, least, most] = [mean, least, most].map(|hours| core_time(3600.0 * hours));
        let measured = chosen.len();
        format!(
            "{mean} for {values} values, from the first ones of {measured} ramps ({least} if all were as the \
             cheapest of them, {most} if as the dearest); denser or refined values add to it"
        )
    })?;
    Ok(End::Done)
}

/// Returns the core hours that the first value of a ramp takes if all its cycles take as long as the measured
/// cycles.
fn hours<E: Experiment>(plan: &Plan<E>, ramp: usize, share: Duration) -> Result<f64, Failure> {
    let cannot = |source| StudyError::Build { ramp, value: 0, source };
    let experiment = plan.experiment(ramp, 0)?;
    let mut run = experiment.build(plan.ramp_seed(ramp)).map_err(cannot)?;
    let mut observer = experiment.observer().map_err(cannot)?;
    let limits = Limits::until(f64::MAX).with_wall_clock(share);
    run.run(&limits, &mut ())?;
    let (meter, start) = (Meter::start(&run), run.time());
    run.run(&limits, &mut observer)?;
    let cycles = (run.time() - start) / experiment.cycle();
    Ok(meter.report(&run).seconds / cycles * plan.protocol().cycles() as f64 / 3600.0)
}
