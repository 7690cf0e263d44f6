//! Table I under each assumption about the walls.

use std::collections::BTreeMap;
use std::error::Error;

use granular_edmd::ParameterError;
use granular_edmd::kinetic::effective_inelasticity;

use crate::numbers::{Average, Number, average};
use crate::ramps::{AS_THE_DISKS, Crossing, ELASTIC_WALLS, Ramp};
use crate::{crossings, is_of};
use gallery::paper::{Row, TABLE_1};
use gallery::results::Results;

const NAME: &str = "transition_lines-walls";

/// Prints Table I under each assumption about the walls, and its distance from the paper's.
pub(crate) fn print(ramps: &[Ramp], results: &Results) -> Result<(), Box<dyn Error>> {
    let columns =
        ["walls", "number", "gravity", "line", "places", "mean_energy_change", "standard_deviation"];
    let mut table = results.table(NAME, &columns)?;
    let mut accounts: BTreeMap<String, Vec<(&Ramp, Crossing)>> = BTreeMap::new();
    for (ramp, at) in crossings(ramps)? {
        for account in account(ramp) {
            accounts.entry(account).or_default().push((ramp, at.clone()));
        }
    }
    for (name, crossings) in &accounts {
        for number in [Number::EqualTemperatures, Number::AsPrinted] {
            gallery::say!("\n{name}, {}", number.name());
            for (gravity, line, Average { along, .. }) in print_account(crossings, number)? {
                let (mean, deviation) = (along.mean(), along.standard_deviation());
                table.serialize((name, number.name(), gravity, line, along.count(), mean, deviation))?;
            }
        }
    }
    results.finish_table(NAME, table, None)
}

/// Returns the names of the walls, with the length of the values. Where disks lose nothing along the normal,
/// walls under their rule are elastic ones, too.
fn account(ramp: &Ramp) -> Vec<String> {
    let both = ramp.along_friction && ramp.experiment.inelasticity == 0.0 && ramp.walls() == AS_THE_DISKS;
    let names = [Some(ramp.walls()), both.then_some(ELASTIC_WALLS)];
    names.into_iter().flatten().map(|walls| format!("{walls}, {} oscillations", ramp.oscillations)).collect()
}

/// A row of Table I as it was found: gravity, line, and the average along it.
type Found = (f64, String, Average);

fn print_account(crossings: &[(&Ramp, Crossing)], number: Number) -> Result<Vec<Found>, ParameterError> {
    let (mut squares, mut rows) = (0.0, Vec::new());
    for Row { gravity, line, change: (mean, deviation), .. } in TABLE_1 {
        let of_line: Vec<_> = crossings.iter().filter(|(ramp, at)| is_of(ramp, at, gravity, line)).collect();
        if of_line.is_empty() {
            continue;
        }
        let found = average(number, &of_line)?;
        squares += ((found.along.mean() - mean) / deviation).powi(2);
        let effective = effective_inelasticity(found.along.mean(), 1.0)?;
        let line = line.to_string();
        gallery::say!(
            "  {gravity:<9} {line:12} paper {mean:.3} ± {deviation:.3}  here {found}  q_eff {effective:.4}"
        );
        rows.push((gravity, line, found));
    }
    let distance = (squares / rows.len() as f64).sqrt();
    gallery::say!("  rms deviation {distance:.2} of the paper's standard deviations");
    Ok(rows)
}
