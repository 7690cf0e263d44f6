//! The results as numbers: a summary for people, JSON for programs.

use granular_edmd::statistics::Estimate;
use serde_json::{Value, json};

use crate::experiment::{Outcome, Sample};

/// A quantity of a sample: its name for programs, its name for people, and its value.
pub(crate) struct Quantity(pub(crate) &'static str, pub(crate) &'static str, pub(crate) fn(&Sample) -> f64);

/// The order parameters, the height, and the energies.
pub(crate) const QUANTITIES: [Quantity; 5] = [
    Quantity("psi1", "Ψ₁, one roll", |(order, ..)| order.one_roll),
    Quantity("psi2", "Ψ₂, two rolls", |(order, ..)| order.two_rolls),
    Quantity("center_of_mass_height", "height of center of mass", |(_, center, _)| center.y),
    Quantity("translational_energy", "translational energy", |(.., energy)| energy.translational),
    Quantity("rotational_energy", "rotational energy", |(.., energy)| energy.rotational),
];

/// Prints the summary.
pub(crate) fn print(outcome: &Outcome) {
    let line = |name: &str, value: &dyn std::fmt::Display| gallery::say!("{name:25} {value}");
    let counters = outcome.simulation.counters();
    line("flow", &outcome.flow);
    let energy_change = ("energy change, collision", outcome.energy_change.disks().estimate());
    let means = QUANTITIES.map(|Quantity(_, name, of)| (name, outcome.mean(of)));
    let means: Vec<_> = means.into_iter().chain([energy_change]).collect();
    // Errors are marked if the series is too short to determine them, unless this holds for all of them.
    let lacking = means.iter().filter(|(_, mean)| !mean.is_converged()).count();
    for (name, mean) in &means {
        let mark = if mean.is_converged() || lacking == means.len() { "" } else { " *" };
        line(name, &format!("{}{mark}", short(mean)));
    }
    line("noise of a gas at rest", &format!("{:.4}", outcome.noise));
    line(
        "disk–disk collisions",
        &format!("{}, {:.2e} per second", counters.disk_collisions, outcome.speed()),
    );
    line("collisions with walls", &counters.wall_collisions);
    line("contact-duration ones", &counters.contact_duration_collisions);
    line("largest overlap", &format!("{:.1e}", counters.max_overlap));
    for warning in outcome.simulation.warnings() {
        line("warning", &warning);
    }
    line("run", &format!("{:.2} s", outcome.seconds));
    line("final state", &outcome.hash());
    if lacking == means.len() {
        gallery::say!("errors are lower bounds after a short run; run longer with --oscillations N");
    } else if lacking > 0 {
        gallery::say!("* not converged: the error is a lower bound; run longer with --oscillations N");
    }
}

/// Formats a mean and its error, with two digits of the error.
fn short(mean: &Estimate) -> String {
    let text = mean.to_string();
    text.split(" (").next().unwrap_or_default().to_owned()
}

/// Returns the results, and the flags that were given.
pub(crate) fn json(outcome: &Outcome) -> Value {
    let counters = outcome.simulation.counters();
    let mut numbers = json!({
        "flow": outcome.flow, "noise": outcome.noise, "samples": outcome.series.values().len(),
        "collisions": counters.disk_collisions, "wall_collisions": counters.wall_collisions,
        "contact_duration_collisions": counters.contact_duration_collisions,
        "max_overlap": counters.max_overlap, "run_seconds": outcome.seconds,
        "collisions_per_second": outcome.speed(), "final_state_hash": outcome.hash(),
        "flags": std::env::args().skip(1).collect::<Vec<_>>(),
    });
    let means = QUANTITIES.map(|Quantity(key, _, of)| (key, outcome.mean(of)));
    let energy_change = ("mean_energy_change", outcome.energy_change.disks().estimate());
    for (key, mean) in means.into_iter().chain([energy_change]) {
        numbers[key] = mean.mean().into();
        numbers[format!("{key}_std_error")] = mean.standard_error().into();
        numbers[format!("{key}_converged")] = mean.is_converged().into();
    }
    numbers
}
