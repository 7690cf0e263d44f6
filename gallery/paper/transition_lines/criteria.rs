//! The lines under other criteria for the names of states, from the samples that the ramps have kept.

use std::collections::BTreeMap;
use std::error::Error;

use granular_edmd::ParameterError;
use granular_edmd::observable::ConvectionOrder;
use granular_edmd_study::analysis::StateCriteria;

use crate::numbers::{Number, average};
use crate::ramps::Ramp;
use crate::{crossings, is_of};
use gallery::paper::{Row, TABLE_1};
use gallery::results::Results;

const NAME: &str = "transition_lines-criteria";

/// Unit of the order parameters in the kept samples.
const UNIT: f64 = 1e-4;

/// The numbers that are averaged.
const NUMBERS: [Number; 2] = [Number::EqualTemperatures, Number::MeasuredRatio];

/// Returns the criteria, each with a name.
fn criteria() -> Result<Vec<(String, StateCriteria)>, ParameterError> {
    let stated = StateCriteria::default();
    let mut all = vec![("as stated".to_owned(), stated)];
    for (packing, order) in [(0.50, 0.06), (0.60, 0.06), (0.65, 0.03), (0.70, 0.03), (0.80, 0.01)] {
        let name = format!("collapse: packing {packing:.2}, Ψ₂ {order}");
        all.push((name, stated.with_collapse(packing, order)?));
    }
    for ratio in [1.0, 1.5, 3.0] {
        all.push((format!("two rolls: |Ψ₂| > {ratio} |Ψ₁|"), stated.with_two_rolls(ratio)?));
    }
    for multiple in [2.0, 4.0] {
        all.push((format!("flow: above {multiple} × noise"), stated.with_noise_multiple(multiple)?));
    }
    Ok(all)
}

/// Prints Table I under each of the criteria.
///
/// The transitions were bisected under the stated criteria. Under others, they are known only to within a
/// step of the ramps.
pub(crate) fn print(ramps: &[Ramp], results: &Results) -> Result<(), Box<dyn Error>> {
    let samples = ramps.iter().map(samples_of).collect::<Result<Vec<_>, _>>()?;
    let columns =
        ["criterion", "number", "gravity", "line", "places", "mean_energy_change", "standard_deviation"];
    let mut table = results.table(NAME, &columns)?;
    for (name, criteria) in criteria()? {
        let mut renamed = ramps.to_vec();
        let mut others = 0;
        for (ramp, samples) in renamed.iter_mut().zip(&samples) {
            others += rename(ramp, samples, &criteria)?;
        }
        gallery::say!("\n{name}: {others} states have another name");
        let crossings = crossings(&renamed)?;
        for Row { gravity, line, .. } in TABLE_1 {
            let of_line: Vec<_> =
                crossings.iter().filter(|(ramp, at)| is_of(ramp, at, gravity, line)).collect();
            for number in NUMBERS {
                let found = average(number, &of_line)?;
                gallery::say!("  {gravity:<9} {line:12} {:34}{found}", number.name());
                let (mean, deviation) = (found.along.mean(), found.along.standard_deviation());
                let line = line.to_string();
                table.serialize((
                    &name,
                    number.name(),
                    gravity,
                    line,
                    found.along.count(),
                    mean,
                    deviation,
                ))?;
            }
        }
    }
    results.finish_table(NAME, table, None)
}

/// The samples of a ramp, by the number of the value.
type Samples = BTreeMap<u32, Vec<ConvectionOrder>>;

fn samples_of(ramp: &Ramp) -> Result<Samples, Box<dyn Error>> {
    let path = ramp.folder.join("order.csv");
    let read = || -> Result<Samples, Box<dyn Error>> {
        let rows = csv::ReaderBuilder::new().has_headers(false).from_path(&path)?;
        let mut samples = Samples::new();
        for row in rows.into_deserialize() {
            let (value, one_roll, two_rolls): (u32, f64, f64) = row?;
            samples.entry(value).or_default().push(ConvectionOrder::new(UNIT * one_roll, UNIT * two_rolls));
        }
        Ok(samples)
    };
    read().map_err(|error| format!("{}: {error}", path.display()).into())
}

/// Names the states of a ramp by these criteria. Returns how many got another name.
fn rename(ramp: &mut Ramp, samples: &Samples, criteria: &StateCriteria) -> Result<u64, Box<dyn Error>> {
    let mut others = 0;
    for seen in &mut ramp.observations {
        let samples = samples.get(&seen.value).ok_or("a value has no samples")?;
        let regime = criteria.classify(samples, seen.noise, Some(seen.layer))?.regime();
        others += u64::from(regime != seen.regime);
        seen.regime = regime;
    }
    Ok(others)
}
