//! Single changes of the paper's box, which may move the collapse at small friction to where the paper has
//! it.
//!
//! At g = 0.002025 and κ = 0.005, inelasticity grows in steps of 0.01 until the disks have collapsed, with
//! three seeds for each cause. The paper's mean ⟨dE⟩ of the collapse, −0.614, is at q = 0.18 here; the box as
//! stated collapses at smaller q. Each row changes one thing.
//!
//! ```text
//! cargo run --release -p gallery --features studies --bin collapse_causes
//! ```

use std::error::Error;
use std::f64::consts::{FRAC_PI_4, TAU};
use std::process::ExitCode;

use clap::Parser;
use gallery::command_line;
use gallery::results::Results;
use granular_edmd::boundary::Container;
use granular_edmd::collision::KnownRule;
use granular_edmd::observable::{Accumulator, HeightProfile, OrderParameters, Temperatures};
use granular_edmd::statistics::RunningMean;
use granular_edmd::{Disk, Simulation};
use granular_edmd_study::Experiment;
use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria, thermal_noise};
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use rayon::prelude::*;

const GRAVITY: f64 = 0.002_025;
const FRICTION: f64 = 0.005;
const FREQUENCY: f64 = 10.0;
const AMPLITUDE: f64 = 0.1;
const HEIGHT: f64 = 150.0;

/// Oscillations between two samples.
const EVERY: u32 = 20;

/// The collapse under single changes of the paper's box.
#[derive(Parser)]
struct Arguments {
    /// Oscillations at each value; the first half is discarded.
    #[arg(long, default_value_t = 16_000)]
    oscillations: u32,
    /// Number of seeds.
    #[arg(long, default_value_t = 3)]
    seeds: u64,
    /// Short runs of one seed.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// One change of the box.
#[derive(Debug, Clone, Copy)]
enum Cause {
    AsStated,
    /// The largest speed of the base is Aω instead of 4Aω/π.
    SlowerBase,
    /// The base is a sinusoid of the same amplitude, with the largest speed Aω.
    Sinusoid,
    /// A slip in the rule at the base, v′ = −r v + 2U instead of −r v + (1 + r) U: the base counts as faster
    /// by 1/(1 − q).
    SlipInTheRule,
    /// The base loses nothing along its normal.
    ElasticNormal,
    /// The base loses nothing.
    LosslessBase,
    /// No wall loses anything.
    LosslessWalls,
    /// Another width of the box: 61 if the paper's 60 is the width for the centers of disks, or 59.
    Width(f64),
    /// The factor β of the moment of inertia βmR².
    Inertia(f64),
    /// The dynamic friction, over the static one.
    DynamicFriction(f64),
}

impl Cause {
    const ALL: [Self; 13] = [
        Self::AsStated,
        Self::SlowerBase,
        Self::Sinusoid,
        Self::SlipInTheRule,
        Self::ElasticNormal,
        Self::LosslessBase,
        Self::LosslessWalls,
        Self::Width(61.0),
        Self::Width(59.0),
        Self::Inertia(0.4),
        Self::Inertia(1.0),
        Self::DynamicFriction(0.5),
        Self::DynamicFriction(0.0),
    ];

    fn name(self) -> String {
        match self {
            Self::AsStated => "as stated".to_owned(),
            Self::SlowerBase => "largest speed of the base Aω".to_owned(),
            Self::Sinusoid => "sinusoid".to_owned(),
            Self::SlipInTheRule => "v' = -rv + 2U at the base".to_owned(),
            Self::ElasticNormal => "base elastic along the normal".to_owned(),
            Self::LosslessBase => "lossless base".to_owned(),
            Self::LosslessWalls => "lossless walls".to_owned(),
            Self::Width(width) => format!("width {width}"),
            Self::Inertia(factor) => format!("inertia {factor} mR²"),
            Self::DynamicFriction(ratio) => format!("dynamic friction {ratio} of the static"),
        }
    }

    fn experiment(self, q: f64) -> VibratedBox {
        let bi_parabolic = |amplitude| Base::BiParabolic { amplitude, angular_frequency: FREQUENCY };
        let base = match self {
            Self::SlowerBase => bi_parabolic(AMPLITUDE * FRAC_PI_4),
            Self::SlipInTheRule => bi_parabolic(AMPLITUDE / (1.0 - q)),
            Self::Sinusoid => Base::Sinusoidal { amplitude: AMPLITUDE, angular_frequency: FREQUENCY },
            _ => bi_parabolic(AMPLITUDE),
        };
        let width = if let Self::Width(width) = self { width } else { 60.0 };
        let mut experiment = VibratedBox::new(1000, width, base)
            .with_height(HEIGHT)
            .with_gravity(GRAVITY)
            .with_inelasticity(q)
            .with_friction(FRICTION)
            .with_contact_duration(1e-4);
        match self {
            Self::ElasticNormal => {
                experiment.base_inelasticity = Some(0.0);
                experiment.base_tangential_inelasticity = Some(q);
            }
            Self::LosslessBase => experiment.base_inelasticity = Some(0.0),
            Self::LosslessWalls => experiment.wall_inelasticity = Some(0.0),
            Self::DynamicFriction(ratio) => experiment.dynamic_friction = Some(ratio * FRICTION),
            _ => {}
        }
        experiment
    }

    fn disks(self, seed: u64) -> Result<Vec<Disk>, Box<dyn Error + Send + Sync>> {
        let disks = self.experiment(FIRST).disks(seed)?;
        let Self::Inertia(factor) = self else { return Ok(disks) };
        Ok(disks.into_iter().map(|disk| disk.with_inertia_factor(factor)).collect::<Result<_, _>>()?)
    }
}

/// The first inelasticity, at which all boxes have two rolls; the step; and the number of values.
const FIRST: f64 = 0.1;
const STEP: f64 = 0.01;
const STEPS: u32 = 15;

/// The state at one inelasticity.
struct Seen {
    inelasticity: f64,
    two_rolls: f64,
    packing: f64,
    regime: ConvectiveRegime,
}

/// Increases the inelasticity until the disks are collapsed at two consecutive values.
fn ramp(cause: Cause, seed: u64, oscillations: u32) -> Result<Vec<Seen>, Box<dyn Error + Send + Sync>> {
    let first = cause.experiment(FIRST);
    let mut run = Simulation::builder(first.rule()?, first.boundary()?)
        .disks(cause.disks(seed)?)
        .gravity(GRAVITY)
        .build()?;
    let (mut all, mut done): (Vec<Seen>, u32) = (Vec::new(), 0);
    for step in 0..STEPS {
        let q = FIRST + STEP * f64::from(step);
        // Every base is at its rest position at the end of each period, so replacing it causes no jump.
        run.set_rule(cause.experiment(q).rule()?);
        run.set_boundary(cause.experiment(q).boundary()?)?;
        all.push(measure(&mut run, q, done, oscillations)?);
        done += oscillations;
        if all.iter().rev().take_while(|seen| seen.regime == ConvectiveRegime::Collapsed).count() == 2 {
            break;
        }
    }
    Ok(all)
}

fn measure(
    run: &mut Simulation<KnownRule, Container>,
    inelasticity: f64,
    done: u32,
    oscillations: u32,
) -> Result<Seen, Box<dyn Error + Send + Sync>> {
    let time = |oscillations: u32| TAU / FREQUENCY * f64::from(done + oscillations);
    let mut profile = HeightProfile::new(0.0, HEIGHT, HEIGHT as usize)?;
    let (mut orders, mut temperature) = (Vec::new(), RunningMean::default());
    run.run_until(time(oscillations / 2), &mut ())?;
    for sample in 1..=oscillations / 2 / EVERY {
        run.run_until(time(oscillations / 2 + sample * EVERY), &mut ())?;
        orders.push(run.measure(&OrderParameters));
        temperature.push(run.measure(&Temperatures).vertical);
        profile.add(&run.snapshot())?;
    }
    gallery::output::warn(&run.warnings());
    let layer = profile.densest_layer();
    let noise = thermal_noise(temperature.mean(), 1.0, run.len())?;
    let regime = StateCriteria::default().classify(&orders, noise, layer)?.regime();
    let two_rolls = orders.iter().map(|order| order.two_rolls).collect::<RunningMean>().mean();
    let packing = layer.map_or(0.0, |layer| layer.packing_fraction);
    Ok(Seen { inelasticity, two_rolls, packing, regime })
}

/// Returns the middle between the last value that is not collapsed and the first that is.
fn collapse(ramp: &[Seen]) -> Option<f64> {
    let at = ramp.iter().position(|seen| seen.regime == ConvectiveRegime::Collapsed)?;
    Some(ramp[at].inelasticity - 0.5 * STEP)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    arguments.results.make_folder()?;
    let (oscillations, seeds) =
        if arguments.quick { (400, 1) } else { (arguments.oscillations, arguments.seeds) };
    let tasks: Vec<_> =
        Cause::ALL.into_iter().flat_map(|cause| (1..=seeds).map(move |seed| (cause, seed))).collect();
    let ramps: Vec<_> =
        tasks.par_iter().map(|&(cause, seed)| ramp(cause, seed, oscillations)).collect::<Vec<_>>();
    let mut table = arguments.results.table(
        "collapse_causes",
        &["cause", "seed", "inelasticity", "state", "two_rolls", "densest_packing"],
    )?;
    let mut found: Vec<(String, RunningMean)> = Vec::new();
    for ((cause, seed), ramp) in tasks.into_iter().zip(ramps) {
        let ramp = ramp.map_err(|error| format!("{}, seed {seed}: {error}", cause.name()))?;
        for seen in &ramp {
            let regime = seen.regime.to_string();
            table.serialize((cause.name(), seed, seen.inelasticity, regime, seen.two_rolls, seen.packing))?;
        }
        if found.last().is_none_or(|(name, _)| *name != cause.name()) {
            found.push((cause.name(), RunningMean::default()));
        }
        if let (Some(at), Some((_, mean))) = (collapse(&ramp), found.last_mut()) {
            mean.push(at);
        }
    }
    arguments.results.finish_table("collapse_causes", table, None)?;
    for (name, at) in &found {
        print_row(name, at);
    }
    Ok(())
}

fn print_row(name: &str, at: &RunningMean) {
    if at.count() == 0 {
        println!("{name:36} no collapse up to q = {:.2}", FIRST + STEP * f64::from(STEPS - 1));
        return;
    }
    let (mean, scatter) = (at.mean(), if at.count() > 1 { at.standard_deviation() } else { 0.0 });
    println!("{name:36} q = {mean:.3} ± {scatter:.3} in {} seeds, in steps of {STEP}", at.count());
}

fn main() -> ExitCode {
    command_line::main(run)
}
