//! The results as text: summary, JSON, table.

use std::fmt::Write as _;
use std::path::Path;

use granular_edmd::statistics::RunningMean;
use serde_json::{Value, json};

use crate::arguments::{Arguments, Sides};
use crate::experiment::{Outcome, Sample};

/// Means over the second half of the samples.
pub(crate) struct Means {
    pub(crate) psi1: RunningMean,
    pub(crate) abs_psi1: RunningMean,
    pub(crate) psi2: RunningMean,
    pub(crate) amplitude: RunningMean,
    pub(crate) center_of_mass_height: RunningMean,
    pub(crate) translational_energy: RunningMean,
    pub(crate) rotational_energy: RunningMean,
}

impl Means {
    /// Computes the means of a run.
    pub(crate) fn of(outcome: &Outcome) -> Self {
        let settled = &outcome.samples[outcome.samples.len() / 2..];
        let mean = |quantity: fn(&Sample) -> f64| settled.iter().map(quantity).collect();
        Self {
            psi1: mean(|sample| sample.order.one_roll),
            abs_psi1: mean(|sample| sample.order.one_roll.abs()),
            psi2: mean(|sample| sample.order.two_rolls),
            amplitude: mean(|sample| sample.order.one_roll.hypot(sample.order.two_rolls)),
            center_of_mass_height: mean(|sample| sample.center_of_mass_height),
            translational_energy: mean(|sample| sample.energies.translational),
            rotational_energy: mean(|sample| sample.energies.rotational),
        }
    }

    /// Returns the standard deviation of `$\Psi_1$` and `$\Psi_2$` in a gas of this temperature without a
    /// flow.
    pub(crate) fn noise(&self, disks: u64) -> f64 {
        (self.translational_energy.mean() / (2.0 * disks as f64)).sqrt()
    }

    /// Describes the flow in words.
    pub(crate) fn verdict(&self, arguments: &Arguments) -> &'static str {
        let (one, two) = (self.abs_psi1.mean(), self.psi2.mean());
        let seen = 2.0 * self.noise(arguments.disks);
        match arguments.sides {
            // Without walls, a pair of rolls drifts from one order parameter to the other.
            Sides::Periodic if self.amplitude.mean() > seen => "two rolls",
            Sides::Walls if two > seen.max(one) => "two rolls",
            Sides::Walls if one > seen && self.psi1.mean() > 0.0 => "one roll, clockwise",
            Sides::Walls if one > seen => "one roll, counterclockwise",
            _ => "neither one roll nor two",
        }
    }
}

/// Returns the summary, for people.
pub(crate) fn summary(arguments: &Arguments, outcome: &Outcome) -> String {
    let means = Means::of(outcome);
    let counters = &outcome.counters;
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<24} {value}");
    };
    line("flow", means.verdict(arguments).to_owned());
    line("psi1", format!("{}   mean of |psi1| {:.4}", figure(&means.psi1), means.abs_psi1.mean()));
    line(
        "psi2",
        format!("{}   noise of a gas at rest {:.4}", figure(&means.psi2), means.noise(arguments.disks)),
    );
    line("center of mass height", figure(&means.center_of_mass_height));
    line("translational energy", format!("{} per disk", figure(&means.translational_energy)));
    line("rotational energy", format!("{} per disk", figure(&means.rotational_energy)));
    line("mean energy change", format!("{:.5} per disk–disk collision", outcome.energy_change));
    line(
        "collisions",
        format!(
            "{} with disks, {} with walls, {} under the contact duration {:.3e}",
            counters.collisions,
            counters.wall_collisions,
            counters.contact_duration_collisions,
            arguments.contact_duration()
        ),
    );
    line("largest overlap", format!("{:.1e}", counters.max_overlap));
    line(
        "run",
        format!("{:.2} s, {:.2e} disk–disk collisions per second", outcome.run_seconds, per_second(outcome)),
    );
    line("final state", outcome.final_state_hash.clone());
    text
}

/// Returns the results, for programs.
pub(crate) fn json(arguments: &Arguments, outcome: &Outcome) -> Value {
    let means = Means::of(outcome);
    let counters = &outcome.counters;
    json!({
        "psi1": means.psi1.mean(),
        "psi2": means.psi2.mean(),
        "abs_psi1": means.abs_psi1.mean(),
        "center_of_mass_height": means.center_of_mass_height.mean(),
        "translational_energy": means.translational_energy.mean(),
        "rotational_energy": means.rotational_energy.mean(),
        "collisions": counters.collisions,
        "wall_collisions": counters.wall_collisions,
        "cell_crossings": counters.cell_crossings,
        "mean_energy_change": outcome.energy_change.mean(),
        "mean_energy_change_std_error": outcome.energy_change.standard_error(),
        "mean_energy_change_converged": outcome.energy_change.is_converged(),
        "contact_duration_collisions": counters.contact_duration_collisions,
        "max_overlap": counters.max_overlap,
        "run_seconds": outcome.run_seconds,
        "collisions_per_second": per_second(outcome),
        "final_state_hash": outcome.final_state_hash,
        "samples": outcome.samples.len(),
        "parameters": parameters(arguments),
    })
}

fn parameters(arguments: &Arguments) -> Value {
    json!({
        "disks": arguments.disks,
        "width": arguments.width,
        "height": arguments.height.0,
        "gravity": arguments.gravity,
        "inelasticity": arguments.inelasticity,
        "friction": arguments.friction,
        "amplitude": arguments.amplitude,
        "omega": arguments.omega,
        "oscillations": arguments.oscillations,
        "every": arguments.every,
        "seed": arguments.seed,
        "base": arguments.base.to_string(),
        "sides": arguments.sides.name(),
        "contact_duration": arguments.contact_duration(),
    })
}

/// Writes the series as a table.
pub(crate) fn write_table(path: &Path, samples: &[Sample]) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_path(path)?;
    table.write_record([
        "oscillation",
        "time",
        "psi1",
        "psi2",
        "center_of_mass_height",
        "translational_energy",
        "rotational_energy",
    ])?;
    for sample in samples {
        let numbers = [
            sample.time,
            sample.order.one_roll,
            sample.order.two_rolls,
            sample.center_of_mass_height,
            sample.energies.translational,
            sample.energies.rotational,
        ];
        let numbers = numbers.iter().map(f64::to_string);
        table.write_record(std::iter::once(sample.oscillation.to_string()).chain(numbers))?;
    }
    table.flush().map_err(csv::Error::from)
}

fn per_second(outcome: &Outcome) -> f64 {
    outcome.counters.collisions as f64 / outcome.run_seconds
}

/// Formats a mean, and how far the samples scatter about it.
fn figure(mean: &RunningMean) -> String {
    format!("{:.4} (scatter {:.4})", mean.mean(), mean.variance().sqrt())
}
