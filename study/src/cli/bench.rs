//! The command `bench`: the standard states of [`speed`], and the core hours of a plan.

use std::path::Path;
use std::time::Duration;

use granular_edmd::Simulation;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::simulation::{Limits, RunError};
use granular_edmd::speed::{self, Circumstances, Meter, Quartiles, RunReport};

use super::terminal::{read, say};
use super::{End, Failure, Plan, StudyError, core_time};
use crate::Experiment;

/// Largest number of ramps whose first values are run in order to estimate the core hours of a plan.
const RAMPS: usize = 4;

type Stretch = Box<dyn Fn(u64) -> Result<RunReport, RunError>>;

/// Prints the time per collision in each standard state.
pub(super) fn table(quick: bool) -> Result<End, Failure> {
    // In a short interval, filling the caches takes a noticeable part of the time.
    let (rounds, collisions) = if quick { (5, 20_000) } else { (31, 100_000) };
    let states: [(&str, Stretch); 7] = [
        ("dilute", stretches(speed::dilute()?)),
        ("dense", stretches(speed::dense()?)),
        ("gas at 0.1", stretches(speed::gas(0.1)?)),
        ("gas at 0.3", stretches(speed::gas(0.3)?)),
        ("gas at 0.65", stretches(speed::gas(0.65)?)),
        ("mixture", stretches(speed::mixture()?)),
        ("vessel", stretches(speed::vessel()?)),
    ];
    let mut reports = states.each_ref().map(|_| Vec::with_capacity(rounds));
    // The states alternate, so that a slow phase of the machine affects one interval of each state.
    for _ in 0..rounds {
        for ((_, stretch), reports) in states.iter().zip(&mut reports) {
            reports.push(stretch(collisions)?);
        }
    }
    say("| state | ns a collision (quartiles) | million a second | events a collision |\n|---|---|---|---|")?;
    for ((name, _), reports) in states.iter().zip(&reports) {
        let time = Quartiles::of(reports.iter().map(|report| report.nanoseconds_per_collision));
        let (rate, events) = (1e3 / time.median, reports[0].events_per_collision);
        say(&format!("| {name} | {time} | {rate:.2} | {events:.3} |"))?;
    }
    say(&Circumstances::present().to_string())?;
    Ok(End::Done)
}

fn stretches(
    run: Simulation<impl CollisionRule + Clone + 'static, impl Boundary + Clone + 'static>,
) -> Stretch {
    Box::new(move |collisions| speed::stretch(&run, collisions, &mut ()))
}

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
