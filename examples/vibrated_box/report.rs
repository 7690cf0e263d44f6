//! The results as numbers: means, summary, JSON.

use granular_edmd::glam::DVec2;
use granular_edmd::observable::{ConvectionOrder, EnergyPerDisk};
use granular_edmd::statistics::RunningMean;
use serde_json::{Value, json};

use crate::arguments::Arguments;
use crate::experiment::Outcome;

/// Means over the second half of the samples.
pub(crate) struct Means {
    psi1: RunningMean,
    abs_psi1: RunningMean,
    psi2: RunningMean,
    amplitude: RunningMean,
    height: RunningMean,
    translational: RunningMean,
    rotational: RunningMean,
}

impl Means {
    pub(crate) fn of(outcome: &Outcome) -> Self {
        let samples = outcome.series.values();
        let settled = &samples[samples.len() / 2..];
        let mean = |of: fn(&(ConvectionOrder, DVec2, EnergyPerDisk)) -> f64| settled.iter().map(of).collect();
        Self {
            psi1: mean(|(order, ..)| order.one_roll),
            abs_psi1: mean(|(order, ..)| order.one_roll.abs()),
            psi2: mean(|(order, ..)| order.two_rolls),
            amplitude: mean(|(order, ..)| order.one_roll.hypot(order.two_rolls)),
            height: mean(|(_, center, _)| center.y),
            translational: mean(|(.., energy)| energy.translational),
            rotational: mean(|(.., energy)| energy.rotational),
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
        // Without walls, a pair of rolls drifts from one order parameter to the other.
        let pair = if arguments.periodic { self.amplitude.mean() > seen } else { two > seen.max(one) };
        match (pair, arguments.periodic || one <= seen) {
            (true, _) => "two rolls",
            (false, true) => "neither one roll nor two",
            _ if self.psi1.mean() > 0.0 => "one roll, clockwise",
            _ => "one roll, counterclockwise",
        }
    }
}

/// Prints the summary, for people.
pub(crate) fn print(arguments: &Arguments, outcome: &Outcome, means: &Means) {
    let Outcome { energy_change, counters, run_seconds, final_state_hash, .. } = outcome;
    let scattered =
        |mean: &RunningMean| format!("{:.4} (scatter {:.4})", mean.mean(), mean.variance().sqrt());
    let [psi1, psi2, height, translational, rotational] =
        [&means.psi1, &means.psi2, &means.height, &means.translational, &means.rotational].map(scattered);
    let (disks, walls, lasting) =
        (counters.collisions, counters.wall_collisions, counters.contact_duration_collisions);
    println!("flow                     {}", means.verdict(arguments));
    println!("psi1                     {psi1}   mean of |psi1| {:.4}", means.abs_psi1.mean());
    println!("psi2                     {psi2}   noise of a gas at rest {:.4}", means.noise(arguments.disks));
    println!("center of mass height    {height}");
    println!("translational energy     {translational} per disk");
    println!("rotational energy        {rotational} per disk");
    println!("mean energy change       {energy_change:.5} per disk–disk collision");
    println!(
        "collisions               {disks} with disks, {walls} with walls, {lasting} under the contact duration {:.3e}",
        arguments.contact_duration()
    );
    println!("largest overlap          {:.1e}", counters.max_overlap);
    println!(
        "run                      {run_seconds:.2} s, {:.2e} disk–disk collisions per second",
        speed(outcome)
    );
    println!("final state              {final_state_hash}");
}

/// Returns the results, for programs.
pub(crate) fn json(arguments: &Arguments, outcome: &Outcome, means: &Means) -> Value {
    let Outcome { energy_change, counters, .. } = outcome;
    json!({
        "psi1": means.psi1.mean(), "psi2": means.psi2.mean(), "abs_psi1": means.abs_psi1.mean(),
        "center_of_mass_height": means.height.mean(),
        "translational_energy": means.translational.mean(), "rotational_energy": means.rotational.mean(),
        "collisions": counters.collisions, "wall_collisions": counters.wall_collisions,
        "contact_duration_collisions": counters.contact_duration_collisions,
        "max_overlap": counters.max_overlap, "mean_energy_change": energy_change.mean(),
        "mean_energy_change_std_error": energy_change.standard_error(),
        "mean_energy_change_converged": energy_change.is_converged(),
        "run_seconds": outcome.run_seconds, "collisions_per_second": speed(outcome),
        "final_state_hash": outcome.final_state_hash, "samples": outcome.series.values().len(),
        "parameters": arguments.to_json(),
    })
}

fn speed(outcome: &Outcome) -> f64 {
    outcome.counters.collisions as f64 / outcome.run_seconds
}
