//! The transitions at q = 0 under one change at a time.

use std::collections::BTreeMap;
use std::error::Error;

use granular_edmd::analysis::TransitionLine;
use granular_edmd::statistics::RunningMean;

use crate::ramps::Ramp;

/// Prints for each study the frictions at which rising ramps end in two rolls and in the collapse: mean and
/// standard error over its seeds, and the shift against the study `as-stated`.
pub(crate) fn print(ramps: &[Ramp]) -> Result<(), Box<dyn Error>> {
    let mut found: BTreeMap<&str, [RunningMean; 2]> = BTreeMap::new();
    for ramp in ramps {
        for (line, mean) in [TransitionLine::OneTwoEnd, TransitionLine::TwoCollapse]
            .iter()
            .zip(found.entry(&ramp.study).or_default())
        {
            let first = ramp.crossings()?.into_iter().find(|at| at.line == *line && at.rising);
            if let Some(at) = first {
                mean.push(at.friction);
            }
        }
    }
    let stated = found.get("as-stated").copied().unwrap_or_default();
    println!("{:34}{:34}collapse from κ", "study", "two rolls from κ");
    for (study, means) in &found {
        let told: Vec<String> = means.iter().zip(&stated).map(|(mean, stated)| shift(mean, stated)).collect();
        println!("{study:34}{:34}{}", told[0], told[1]);
    }
    Ok(())
}

fn shift(mean: &RunningMean, stated: &RunningMean) -> String {
    if mean.count() == 0 {
        return "none seen".to_owned();
    }
    let relative = 100.0 * (mean.mean() / stated.mean() - 1.0);
    format!("{:.4} ± {:.4} ({relative:+.0} %), {}", mean.mean(), mean.standard_error(), mean.count())
}
