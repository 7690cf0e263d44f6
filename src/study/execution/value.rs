//! One value of a run: read if it is finished, continued if it was begun, and otherwise run from its start.

use std::path::Path;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::active::{Active, Partial, Value};
use super::shift::{LOOK, Shift};
use crate::simulation::{RunEnd, RunError};
use crate::study::errors::StudyError;
use crate::study::experiment::Experiment;
use crate::study::experiment::record::{Contents, Origin, Record};
use crate::study::folder::{Lock, sealed};
use crate::study::json::Object;
use crate::study::plan::refinement::Step;

/// Shortest piece of a run, so that it advances even if it is saved all the time.
const SHORTEST: Duration = Duration::from_millis(20);

/// A value to be run.
pub(super) struct Task<'a, E: Experiment> {
    pub(super) ramp: usize,
    pub(super) value: usize,
    pub(super) step: Step,
    /// The record from which the value starts, if there is one.
    pub(super) before: Option<&'a Record<E>>,
    /// True if nothing of the ramp was ever begun.
    pub(super) is_fresh: bool,
}

/// The reason why a value stopped.
enum Pause {
    Done,
    Interrupted,
    Stopped,
    Failed(RunError),
}

/// Returns the record of a value; `None` if the value is not finished.
pub(super) fn known<E: Experiment>(
    shift: &Shift<'_, E>,
    lock: &mut Lock,
    ramp: usize,
    value: usize,
    step: Step,
) -> Result<Option<Record<E>>, StudyError> {
    let folder = &shift.study.folder;
    let read = shift.study.record(ramp, value).and_then(|record| match record {
        // It may belong to another step, if an earlier value was run again since.
        Some(record) if (record.leg(), record.ramped_value()) != (step.leg, step.at) => {
            Err(sealed::damaged(&folder.record(ramp, value), "it is of another value"))
        }
        record => Ok(record),
    });
    let record = if_sound(shift, lock, ramp, read)?;
    if record.is_some() {
        shift.meter.advance(ramp, value, shift.study.plan().protocol().steps());
        // A process that was killed just after it had finished a value may have left this file.
        sealed::remove(&folder.partial(ramp, value))?;
    }
    Ok(record)
}

/// Returns the contents of a file. It logs a damaged file and returns `None`.
fn if_sound<T, E: Experiment>(
    shift: &Shift<'_, E>,
    lock: &mut Lock,
    ramp: usize,
    read: Result<Option<T>, StudyError>,
) -> Result<Option<T>, StudyError> {
    match read {
        Err(StudyError::Damaged { path, reason }) => {
            shift.study.folder.mark_undone(ramp)?;
            lock.append(&Object::default().text("damaged", &name(&path)).text("reason", &reason).line());
            shift.note_damaged(path);
            Ok(None)
        }
        other => other,
    }
}

/// Runs a value; `None` if it was interrupted.
pub(super) fn done<E: Experiment>(
    shift: &Shift<'_, E>,
    lock: &mut Lock,
    task: &Task<'_, E>,
) -> Result<Option<Record<E>>, StudyError> {
    let (study, started) = (shift.study, Instant::now());
    let Task { ramp, value, step, before, is_fresh } = *task;
    // A plan of many values has not tried all of them.
    let experiment = study.plan.sound_experiment(&study.plan.parameters_at(ramp, step.at))?;
    let origin = study.origin(ramp, value);
    let work = Value { plan: &study.plan, origin, experiment, step, before };
    let saved = if is_fresh { None } else { if_sound(shift, lock, ramp, saved(shift, &work))? };
    // A damaged one is still there.
    let mut has_partial = !is_fresh;
    let mut active = saved.map_or_else(|| work.begin(), Ok)?;
    shift.meter.advance(ramp, value, active.steps());
    let record = match steps(shift, &mut active, &mut has_partial)? {
        Pause::Done => active.record(),
        Pause::Interrupted => return Ok(None),
        Pause::Stopped => active.stopped(),
        Pause::Failed(error) => active.failed(&error)?,
    };
    shift.open_study()?;
    let path = study.folder.record(ramp, value);
    sealed::write_sealed::<Contents<E::Sample, E::Observer>>(&path, &record.contents)?;
    if has_partial {
        sealed::remove(&study.folder.partial(ramp, value))?;
    }
    log(lock, &record, started);
    Ok(Some(record))
}

/// Returns an unfinished value as it was saved, if there is one.
fn saved<'v, E: Experiment>(
    shift: &Shift<'_, E>,
    value: &'v Value<'_, E>,
) -> Result<Option<Active<'v, E>>, StudyError> {
    let Origin { ramp, value: index, .. } = value.origin;
    let path = shift.study.folder.partial(ramp, index);
    let Some(partial) = sealed::read_sealed::<Partial<E>>(&path)? else { return Ok(None) };
    shift.study.check_origin(&partial.0, ramp, index, &path)?;
    value.go_on(partial).map(Some).map_err(|reason| sealed::damaged(&path, reason))
}

/// Runs the steps of a value until it is finished, piece by piece, and saves it now and then.
fn steps<E: Experiment>(
    shift: &Shift<'_, E>,
    active: &mut Active<'_, E>,
    has_partial: &mut bool,
) -> Result<Pause, StudyError> {
    let (ramp, value) = active.place();
    let path = shift.study.folder.partial(ramp, value);
    let mut save = |active: &Active<'_, E>| {
        *has_partial = true;
        sealed::write_sealed::<Partial<E>>(&path, &active.partial())
    };
    let mut saved = Instant::now();
    while !active.is_done() {
        if shift.must_stop() {
            save(active)?;
            return Ok(Pause::Interrupted);
        }
        if saved.elapsed() > shift.control.save_interval() {
            save(active)?;
            saved = Instant::now();
        }
        let rest = shift.study.plan.protocol().steps() - active.steps();
        let until_save = shift.control.save_interval().saturating_sub(saved.elapsed());
        let ended = active.step(until_save.clamp(SHORTEST, LOOK));
        match ended {
            Ok(RunEnd::Time) => shift.meter.advance(ramp, value, 1),
            Ok(RunEnd::WallClock) => {}
            Ok(_) | Err(_) => shift.meter.advance(ramp, value, rest),
        }
        match ended {
            Ok(RunEnd::Time | RunEnd::WallClock) => {}
            Ok(_) => return Ok(Pause::Stopped),
            Err(error) => return Ok(Pause::Failed(error)),
        }
    }
    Ok(Pause::Done)
}

fn log<E: Experiment>(lock: &mut Lock, record: &Record<E>, started: Instant) {
    let unix_time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    let line = Object::default().with("ramp", record.ramp_index()).with("value", record.value_index());
    let line = line.text("outcome", record.outcome().name());
    let line = record.outcome().reason().into_iter().fold(line, |line, reason| line.text("reason", reason));
    let warnings: Vec<String> = record.counters().warnings().iter().map(ToString::to_string).collect();
    let line = if warnings.is_empty() { line } else { line.text("warnings", &warnings.join("; ")) };
    let line = line.with("collisions", record.counters().disk_collisions);
    let line = line.with("seconds", format_args!("{:.3}", started.elapsed().as_secs_f64()));
    lock.append(&line.with("unix_time", unix_time).line());
}

/// Returns the name of a file after the name of its folder.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}
