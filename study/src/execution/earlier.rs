//! Earlier studies, whose values a run takes over instead of computing them again.

use std::collections::HashMap;
use std::path::PathBuf;

use crate::parameters;
use crate::plan::refinement::{Seen, Step};
use crate::{Difference, Experiment, Outcome, Plan, PlanError, Record, Study, StudyError};

/// Earlier studies, each with the indices of its ramps by seed.
pub(super) struct Earlier<E: Experiment>(Vec<(Study<E>, HashMap<u64, usize>)>);

/// The ramps of earlier studies that agree with a ramp of this study in all values so far.
pub(super) struct SameRamps<'a, E: Experiment>(Vec<(&'a Study<E>, usize)>);

impl<E: Experiment> Earlier<E> {
    pub(super) fn open(folders: &[PathBuf], plan: &Plan<E>) -> Result<Self, StudyError> {
        let open = |folder: &PathBuf| {
            let study = Study::open(folder)?;
            StudyError::if_different(folder, differences(&study.plan, plan)?)?;
            study.store.refreshed()?;
            let ramps = (0..study.plan.ramp_count()).map(|ramp| (study.plan.ramp_seed(ramp), ramp)).collect();
            Ok((study, ramps))
        };
        folders.iter().map(open).collect::<Result<_, _>>().map(Self)
    }

    /// Returns the ramps of this seed.
    pub(super) fn ramps(&self, seed: u64) -> SameRamps<'_, E> {
        let found = self.0.iter().filter_map(|(study, ramps)| Some((study, *ramps.get(&seed)?)));
        SameRamps(found.collect())
    }
}

impl<E: Experiment> SameRamps<'_, E> {
    /// Returns the record of the next value of a plan after the records seen so far, if one of the studies
    /// has the record.
    pub(super) fn next(
        &mut self,
        plan: &Plan<E>,
        seen: &[Seen],
        step: Step,
    ) -> Result<Option<Record<E>>, StudyError> {
        // After a value with more samples, the next one starts from another state.
        let are_same = |other: &Plan<E>| seen.is_empty() || other.protocol() == plan.protocol();
        self.0.retain(|(study, _)| are_same(&study.plan) && study.plan.next(seen) == Some(step));
        for (study, ramp) in &self.0 {
            let record = study.known_record(*ramp, seen.len())?;
            // Values from other code that the earlier study accepted are computed again here, and so are
            // values that a limit ended, which may have been the clock's.
            let is_ours = |record: &Record<E>| study.is_ours(&record.contents.origin);
            let is_whole = |record: &Record<E>| !matches!(record.outcome(), Outcome::Limited { .. });
            if let Some(record) = record.filter(|record| is_ours(record) && is_whole(record)) {
                return Ok(Some(record));
            }
        }
        Ok(None)
    }
}

/// Returns the fields in which two plans differ, except for fields by which a study may grow.
fn differences<E: Experiment>(old: &Plan<E>, new: &Plan<E>) -> Result<Vec<Difference>, PlanError> {
    const FREE: [&str; 7] =
        ["repeats", "end_states", "sweep", "protocol.samples", "ramp.values", "ramp.course", "ramp.refine"];
    let mut all = parameters::differences(&parameters::tree(old)?, &parameters::tree(new)?);
    let is_free =
        |field: &str| FREE.iter().any(|free| field == *free || field.starts_with(&format!("{free}.")));
    let varies = |field: &str| {
        field.strip_prefix("experiment.").is_some_and(|name| new.varied.iter().any(|varied| varied == name))
    };
    all.retain(|Difference { field, .. }| !is_free(field) && !varies(field));
    let swept = |plan: &Plan<E>| {
        let mut names = plan.varied[..plan.sweep.len()].to_vec();
        names.sort();
        names.join(", ")
    };
    let [old, new] = [old, new].map(swept);
    if old != new {
        let field = "the list of swept parameters".to_owned();
        all.push(Difference { field, old: Some(old), new: Some(new) });
    }
    Ok(all)
}
