//! The results as numbers: means, summary, JSON.

use std::fmt::Write as _;

use granular_edmd::observable::{ConvectionOrder, EnergyPerDisk};
use granular_edmd::statistics::RunningMean;
use serde_json::{Value, json};

use crate::arguments::Arguments;
use crate::experiment::Outcome;

/// Means over the second half of the samples.
pub(crate) struct Means {
    pub(crate) psi1: RunningMean,
    abs_psi1: RunningMean,
    psi2: RunningMean,
    amplitude: RunningMean,
    height: RunningMean,
    translational: RunningMean,
    rotational: RunningMean,
}

impl Means {
    pub(crate) fn of(outcome: &Outcome) -> Self {
        let values = outcome.series.values();
        let settled = &values[values.len() / 2..];
        let order = |of: fn(&ConvectionOrder) -> f64| settled.iter().map(|(order, ..)| of(order)).collect();
        let energy = |of: fn(&EnergyPerDisk) -> f64| settled.iter().map(|(.., energy)| of(energy)).collect();
        Self {
            psi1: order(|order| order.one_roll),
            abs_psi1: order(|order| order.one_roll.abs()),
            psi2: order(|order| order.two_rolls),
            amplitude: order(|order| order.one_roll.hypot(order.two_rolls)),
            height: settled.iter().map(|(_, center, _)| center.y).collect(),
            translational: energy(|energy| energy.translational),
            rotational: energy(|energy| energy.rotational),
        }
    }

    /// Returns the standard deviation of `$\Psi_1$` and `$\Psi_2$` in a gas of this temperature without a
    /// flow.
    pub(crate) fn noise(&self, disks: u64) -> f64 {
        (self.translational.mean() / (2.0 * disks as f64)).sqrt()
    }

    /// Describes the flow in words.
    pub(crate) fn verdict(&self, arguments: &Arguments) -> &'static str {
        let (one, two) = (self.abs_psi1.mean(), self.psi2.mean());
        let seen = 2.0 * self.noise(arguments.disks);
        if arguments.periodic {
            // Without walls, a pair of rolls drifts from one order parameter to the other.
            return if self.amplitude.mean() > seen { "two rolls" } else { "neither one roll nor two" };
        }
        if two > seen.max(one) {
            "two rolls"
        } else if one <= seen {
            "neither one roll nor two"
        } else if self.psi1.mean() > 0.0 {
            "one roll, clockwise"
        } else {
            "one roll, counterclockwise"
        }
    }
}

/// Returns the summary, for people.
pub(crate) fn summary(arguments: &Arguments, outcome: &Outcome, means: &Means) -> String {
    let counters = &outcome.counters;
    let noise = means.noise(arguments.disks);
    let collisions = format!(
        "{} with disks, {} with walls, {} under the contact duration {:.3e}",
        counters.collisions,
        counters.wall_collisions,
        counters.contact_duration_collisions,
        arguments.contact_duration()
    );
    let speed = per_second(outcome);
    let lines = [
        ("flow", means.verdict(arguments).to_owned()),
        ("psi1", format!("{}   mean of |psi1| {:.4}", figure(&means.psi1), means.abs_psi1.mean())),
        ("psi2", format!("{}   noise of a gas at rest {noise:.4}", figure(&means.psi2))),
        ("center of mass height", figure(&means.height)),
        ("translational energy", format!("{} per disk", figure(&means.translational))),
        ("rotational energy", format!("{} per disk", figure(&means.rotational))),
        ("mean energy change", format!("{:.5} per disk–disk collision", outcome.energy_change)),
        ("collisions", collisions),
        ("largest overlap", format!("{:.1e}", counters.max_overlap)),
        ("run", format!("{:.2} s, {speed:.2e} disk–disk collisions per second", outcome.run_seconds)),
        ("final state", outcome.final_state_hash.clone()),
    ];
    lines.iter().fold(String::new(), |mut text, (name, value)| {
        let _ = writeln!(text, "{name:<24} {value}");
        text
    })
}

/// Returns the results, for programs.
pub(crate) fn json(arguments: &Arguments, outcome: &Outcome, means: &Means) -> Value {
    let counters = &outcome.counters;
    json!({
        "psi1": means.psi1.mean(),
        "psi2": means.psi2.mean(),
        "abs_psi1": means.abs_psi1.mean(),
        "center_of_mass_height": means.height.mean(),
        "translational_energy": means.translational.mean(),
        "rotational_energy": means.rotational.mean(),
        "collisions": counters.collisions,
        "wall_collisions": counters.wall_collisions,
        "contact_duration_collisions": counters.contact_duration_collisions,
        "max_overlap": counters.max_overlap,
        "mean_energy_change": outcome.energy_change.mean(),
        "mean_energy_change_std_error": outcome.energy_change.standard_error(),
        "mean_energy_change_converged": outcome.energy_change.is_converged(),
        "run_seconds": outcome.run_seconds,
        "collisions_per_second": per_second(outcome),
        "final_state_hash": outcome.final_state_hash,
        "samples": outcome.series.values().len(),
        "parameters": arguments.to_json(),
    })
}

fn per_second(outcome: &Outcome) -> f64 {
    outcome.counters.collisions as f64 / outcome.run_seconds
}

/// Formats a mean, and how far the samples scatter about it.
fn figure(mean: &RunningMean) -> String {
    format!("{:.4} (scatter {:.4})", mean.mean(), mean.variance().sqrt())
}
