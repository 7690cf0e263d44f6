//! One ramp, value after value: a finished value is read, an unfinished value is continued, and any other
//! value is run from its start.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::value::{Active, Partial, Value};
use super::{LOOK, Session};
use crate::experiment::record::{Contents, Outcome, Record};
use crate::folder::{create, encoded, read_sealed, remove, write_sealed};
use crate::plan::ramp::{Seen, Step};
use crate::store::Head;
use crate::{Experiment, Plan, Study, StudyError};

/// Shortest part of a run between two saves. It makes a run advance even if saving takes longer than the save
/// interval.
const SHORTEST: Duration = Duration::from_millis(20);

/// The progress through a ramp.
struct Walk<'a, 's, E: Experiment> {
    session: &'a Session<'s, E>,
    ramp: usize,
    /// The ramps of earlier studies that have agreed with this ramp in all values so far.
    earlier: Vec<(&'a Study<E>, usize)>,
    seen: Vec<Seen>,
    last: Option<Record<E>>,
    /// True if the next value has a file with its unfinished state. An attempt to remove a file that is not
    /// there would cost each value a call of the system.
    has_partial: bool,
}

/// Runs the ramps of a block until they are done or the run must stop. Returns false if another process is
/// running the block.
pub(super) fn attempt<E: Experiment>(session: &Session<'_, E>, block: usize) -> Result<bool, StudyError> {
    let study = session.study;
    let Some(_claim) = study.store.claim(block)? else { return Ok(false) };
    if let Some(error) = study.store.damage(block).filter(|_| !session.is_done(block)) {
        session.if_sound::<()>(Err(error))?;
    }
    for ramp in session.ramps_of(block) {
        if session.must_stop() {
            break;
        }
        if study.store.is_done(ramp) && !session.control.verifies {
            session.skip(1);
            continue;
        }
        let earlier = session.earlier_ramps(study.plan().ramp_seed(ramp));
        let mut walk = Walk { session, ramp, earlier, seen: Vec::new(), last: None, has_partial: false };
        while let Some(step) = study.plan().next(&walk.seen) {
            if !walk.take(step)? {
                break;
            }
        }
    }
    study.store.sync(block)?;
    Ok(true)
}

impl<E: Experiment> Walk<'_, '_, E> {
    /// Runs one value; returns false if it was interrupted.
    fn take(&mut self, step: Step) -> Result<bool, StudyError> {
        let (study, value) = (self.session.study, self.seen.len());
        self.has_partial = false;
        if value >= study.plan.value_count() {
            self.session.count_more();
        }
        if let Some(record) = self.known(step)? {
            self.seen.push(study.plan.seen(&record));
            self.last = Some(record);
            return Ok(true);
        }
        if self.session.must_stop() {
            return Ok(false);
        }
        let before = match step.before {
            // A bisection starts from an earlier value.
            Some(before) if before + 1 < value => study.record(self.ramp, before)?,
            _ => self.last.take(),
        };
        self.new_value(step, before)
    }

    /// Returns the record of the next value, or `None` if the value is not finished.
    fn known(&mut self, step: Step) -> Result<Option<Record<E>>, StudyError> {
        let (study, ramp, value) = (self.session.study, self.ramp, self.seen.len());
        let Some(entry) = study.store.find(ramp, value) else { return Ok(None) };
        let read = study.read(&entry).and_then(|record| {
            // The record may belong to another step, if an earlier value was run again since.
            let is_same = (record.leg(), record.ramped_value()) == (step.leg, step.at);
            if is_same {
                Ok(Some(record))
            } else {
                Err(study.store.damaged(&entry, "it is of another value"))
            }
        });
        let record = self.session.if_sound(read)?;
        if record.is_some() {
            self.advance(study.plan.protocol().steps());
        }
        Ok(record)
    }

    /// Takes over the next value from an earlier study, or runs it from the record `before`. Returns false if
    /// the value was interrupted.
    fn new_value(&mut self, step: Step, before: Option<Record<E>>) -> Result<bool, StudyError> {
        let (study, value, started) = (self.session.study, self.seen.len(), Instant::now());
        // The value is checked now, since a new plan with many values is checked at only some of them.
        let experiment = study.plan.sound_experiment(self.ramp, step.at)?;
        let origin = study.origin(self.ramp, value);
        let work = Value { study, origin, experiment, step, before };
        let mut earlier = self.earlier(step)?;
        if let Some(record) = earlier.take_if(|record| work.is_finished_by(record)) {
            self.advance(study.plan.protocol().steps());
            return self.keep(work.taken_over(record), None);
        }
        let mut active = match self.saved(&work)? {
            Some(active) => active,
            None => work.begin(earlier)?,
        };
        self.advance(active.steps());
        let Some(outcome) = self.steps(&mut active)? else { return Ok(false) };
        self.keep(active.record(outcome)?, Some(started.elapsed()))
    }

    /// Returns an earlier study's record of the next value, or `None` if no earlier study has a suitable one.
    fn earlier(&mut self, step: Step) -> Result<Option<Record<E>>, StudyError> {
        let (plan, seen) = (&self.session.study.plan, &self.seen);
        // Each value starts where the previous one ended. After an earlier study's value with other samples,
        // the next value there started from a state that is not this study's.
        let are_same = |other: &Plan<E>| seen.is_empty() || other.protocol() == plan.protocol();
        self.earlier.retain(|(study, _)| are_same(&study.plan) && study.plan.next(seen) == Some(step));
        for (study, ramp) in &self.earlier {
            let record = study.known_record(*ramp, seen.len())?;
            // Values that other code made are computed again, even if the earlier study accepted this code.
            // Values that a limit ended are computed again, too: it may have been the limit on wall-clock
            // time.
            let is_ours = |record: &Record<E>| study.is_ours(&record.contents.origin);
            let is_whole = |record: &Record<E>| !matches!(record.outcome(), Outcome::Limited { .. });
            if let Some(record) = record.filter(|record| is_ours(record) && is_whole(record)) {
                return Ok(Some(record));
            }
        }
        Ok(None)
    }

    /// Returns the saved data of an unfinished value, or `None` if there are none.
    fn saved<'v>(&mut self, value: &'v Value<'_, E>) -> Result<Option<Active<'v, E>>, StudyError> {
        let (study, index) = (self.session.study, self.seen.len());
        let path = study.folder.partial(self.ramp, index);
        let read = read_sealed::<Partial<E>>(&path);
        self.has_partial = !matches!(read, Ok(None));
        let read = read.and_then(|partial| {
            let Some(partial) = partial else { return Ok(None) };
            study.check_origin(&partial.0.origin, self.ramp, index, &path)?;
            value.go_on(partial, &path).map(Some)
        });
        self.session.if_sound(read)
    }

    /// Runs the steps of a value until the value is finished, and saves the value at intervals. Returns
    /// `None` if it was interrupted.
    fn steps(&mut self, active: &mut Active<'_, E>) -> Result<Option<Outcome>, StudyError> {
        let control = self.session.control;
        let (began, mut saved) = (Instant::now(), Instant::now());
        while !active.is_done() {
            if self.session.must_stop() {
                self.save(active)?;
                return Ok(None);
            }
            if saved.elapsed() > control.save_interval {
                self.save(active)?;
                saved = Instant::now();
            }
            let until_save = control.save_interval.saturating_sub(saved.elapsed());
            let ended = match control.most_seconds.filter(|most| began.elapsed().as_secs_f64() > *most) {
                Some(most) => Err(active.limited(format!("it has taken more than {most} s"))),
                None => active.step(until_save.clamp(SHORTEST, LOOK)),
            };
            match ended {
                Ok(true) => self.advance(1),
                Ok(false) => {}
                Err(outcome) => {
                    self.advance(self.session.study.plan.protocol().steps() - active.steps());
                    return Ok(Some(outcome));
                }
            }
        }
        Ok(Some(Outcome::Completed))
    }

    fn save(&mut self, active: &Active<'_, E>) -> Result<(), StudyError> {
        self.has_partial = true;
        let folder = &self.session.study.folder;
        let path = folder.partial(self.ramp, self.seen.len());
        let partial = active
            .partial()
            .map_err(|source| StudyError::Encode { path: path.clone(), source: source.into() })?;
        path.parent().map_or(Ok(()), create)?;
        write_sealed::<Partial<E>>(&path, &partial)
    }

    /// Stores the record of a value, with the time that the value took (`None` if the record comes from an
    /// earlier study). The record becomes the last one of this ramp.
    fn keep(&mut self, record: Record<E>, time: Option<Duration>) -> Result<bool, StudyError> {
        let study = self.session.study;
        self.seen.push(study.plan.seen(&record));
        // The tables may lack this value, and later ones of the run.
        if !self.session.is_opened.swap(true, Ordering::Relaxed) {
            remove(&study.folder.complete())?;
        }
        let marks = [
            (Head::LAST, study.plan.next(&self.seen).is_none()),
            (Head::FAILED, record.outcome().reason().is_some()),
            (Head::WARNED, !record.warnings().is_empty()),
        ];
        let marks = marks.iter().filter(|(_, is_due)| *is_due).map(|(mark, _)| mark).sum();
        let seconds = time.map_or(f32::NAN, |time| time.as_secs_f32());
        let head = Head { ramp: self.ramp, value: record.value_index(), marks, seconds };
        let contents = encoded::<Contents<E::Sample, E::Observer>>(study.folder(), &record.contents)?;
        study.store.push(head, &contents)?;
        if self.has_partial {
            remove(&study.folder.partial(self.ramp, record.value_index()))?;
        }
        self.last = Some(record);
        Ok(true)
    }

    /// Counts steps of the next value.
    fn advance(&self, steps: u64) {
        self.session.advance(self.ramp, self.seen.len(), steps);
    }
}
