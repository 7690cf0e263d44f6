//! The transitions at q = 0 under one change at a time.

use std::collections::BTreeMap;
use std::error::Error;

use granular_edmd::statistics::RunningMean;
use granular_edmd_study::analysis::ConvectiveRegime::TwoRolls;
use granular_edmd_study::analysis::TransitionLine;

use crate::ramps::Ramp;
use gallery::results::Results;

const NAME: &str = "transition_lines-dependences";

/// The transitions that are followed.
const LINES: [TransitionLine; 3] =
    [TransitionLine::OneTwoBeginning, TransitionLine::OneTwoEnd, TransitionLine::TwoCollapse];

/// Prints for each study the frictions at which rising ramps first have two rolls, last have one, and
/// collapse: mean and standard error over its seeds, and the shift against the study `as-stated`.
pub(crate) fn print(ramps: &[Ramp], results: &Results) -> Result<(), Box<dyn Error>> {
    let mut found: BTreeMap<&str, [RunningMean; 3]> = BTreeMap::new();
    for ramp in ramps {
        for (line, mean) in LINES.iter().zip(found.entry(&ramp.study).or_default()) {
            // A wide box has two rolls from the first friction on. Two rolls that come and go near its
            // collapse are not a transition to two rolls.
            if *line != TransitionLine::TwoCollapse && ramp.observations[0].regime == TwoRolls {
                continue;
            }
            let first = ramp.crossings()?.into_iter().find(|at| at.line == *line && at.rising);
            if let Some(at) = first {
                mean.push(at.friction);
            }
        }
    }
    let stated = found.get("as-stated").copied().unwrap_or_default();
    gallery::say!("{:30}{:34}{:34}collapse from κ", "study", "first two rolls at κ", "last roll alone at κ");
    let mut table = results.table(NAME, &["study", "line", "ramps", "friction", "standard_error"])?;
    for (study, means) in &found {
        for (line, mean) in LINES.iter().zip(means) {
            table.serialize((study, line.to_string(), mean.count(), mean.mean(), mean.standard_error()))?;
        }
        let told: Vec<String> = means.iter().zip(&stated).map(|(mean, stated)| shift(mean, stated)).collect();
        gallery::say!("{study:30}{:34}{:34}{}", told[0], told[1], told[2]);
    }
    results.finish_table(NAME, table, None)
}

fn shift(mean: &RunningMean, stated: &RunningMean) -> String {
    if mean.count() == 0 {
        return "none seen".to_owned();
    }
    let relative = 100.0 * (mean.mean() / stated.mean() - 1.0);
    format!("{:.4} ± {:.4} ({relative:+.0} %), {}", mean.mean(), mean.standard_error(), mean.count())
}
