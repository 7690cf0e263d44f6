//! The command `replay`, which runs a value again and writes its collisions, or the state before a collision.

use std::collections::VecDeque;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use granular_edmd::replay::{Replayed, Steps};
use granular_edmd::trajectory::State;

use super::arguments::Replay;
use super::convert::Ending;
use super::source::{HEADINGS, Source, row, tell_end};
use super::terminal::{end_at_once, wrote};
use super::{End, Failure, PlanError, StudyError};
use crate::{Experiment, Run};

/// Default number of collisions to write.
const FEW: usize = 10;

/// Number of collisions between two updates of the display, after which rows are written.
const BATCH: u64 = 1024;

/// Runs a value again, and writes the requested collisions or the requested state. An incomplete file is
/// removed.
pub(super) fn replay<E: Experiment>(wishes: &Replay) -> Result<End, Failure> {
    let source = Source::<E>::open(&wishes.plan, &wishes.place, wishes.place.start.as_deref())?;
    wishes.check(&source)?;
    let mut out: Box<dyn Write> = match &wishes.out {
        Some(path) => Box::new(fs::File::create_new(path).map_err(StudyError::io("write", path))?),
        None => Box::new(io::stdout()),
    };
    let mut write = |bytes: &[u8]| {
        let written = out.write_all(bytes).and_then(|()| out.flush());
        wrote(written, wishes.out.as_deref().unwrap_or(Path::new("standard output")))
    };
    end_at_once(wishes.out.clone())?;
    let written = match wishes.before {
        Some(number) => state_before(number, source, wishes.out.as_deref(), &mut write),
        None => rows(wishes, source, &mut write),
    };
    if let (Some(path), Err(_)) = (&wishes.out, &written) {
        let _ = fs::remove_file(path);
    }
    written.map(|()| End::Done)
}

impl Replay {
    /// Returns an error if the run ends before `--from`, or cannot contain the disk of `--disk`.
    fn check<E: Experiment>(&self, Source { run, end, .. }: &Source<E>) -> Result<(), PlanError> {
        let is_there = |id: &u64| run.index_of(*id).is_some() || !run.inlets().is_empty();
        match (self.from, self.disk.filter(|id| !is_there(id))) {
            (Some(from), _) if from.is_nan() || from >= *end => {
                Err(PlanError::Refused(format!("no time is after {from} and until {end}")))
            }
            (_, Some(id)) => {
                Err(PlanError::Refused(format!("there is no disk {id} among the {} of the run", run.len())))
            }
            _ => Ok(()),
        }
    }
}

/// Writes all collisions as they occur, or the last collisions at the end.
fn rows<E: Experiment>(
    wishes: &Replay,
    mut source: Source<E>,
    write: &mut impl FnMut(&[u8]) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let (end, show) = (source.end, source.clock());
    if let Some(from) = wishes.from.filter(|from| *from > source.run.time()) {
        source.advance(from, u64::MAX, &show)?;
    }
    let last = wishes.last.unwrap_or(if wishes.from.is_some() { usize::MAX } else { FEW });
    let is_own = |it: &Replayed| wishes.disk.is_none_or(|id| it.id == id || it.partner_id == Some(id));
    let (mut steps, mut kept) = (Steps::new(source.run), VecDeque::new());
    let mut text = HEADINGS.to_owned() + "\n";
    for number in 1.. {
        // If the run ends with an error, the collisions before the error are still written.
        let next = steps.next(end).unwrap_or_else(|error| {
            tell_end(steps.run(), &error);
            None
        });
        let is_over = next.is_none();
        kept.extend(next.filter(is_own));
        kept.drain(..kept.len().saturating_sub(last));
        if !is_over && number % BATCH != 0 {
            continue;
        }
        show(steps.run().time());
        if is_over || last == usize::MAX {
            text.extend(kept.drain(..).map(|it| row(&it, steps.run().boundary()) + "\n"));
            if !write(text.as_bytes())? || is_over {
                break;
            }
            text.clear();
        }
    }
    Ok(())
}

/// Writes the state before a collision, even if the collision ended the run with an error.
fn state_before<E: Experiment>(
    number: u64,
    mut source: Source<E>,
    path: Option<&Path>,
    write: &mut impl FnMut(&[u8]) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let (first, end, show) = (source.run.counters().collisions() + 1, source.end, source.clock());
    if number < first {
        let message = format!("the first collision of this run has the number {first}, not {number}");
        return Err(PlanError::Refused(message).into());
    }
    let ended = source.advance(end, number - 1, show);
    let found = source.run.counters().collisions();
    if found + 1 < number {
        ended?;
    }
    let state = contents::<E>(&mut source.run, path)?;
    // The run may end without a further collision.
    if found + 1 < number || matches!(Steps::new(source.run).next(end), Ok(None)) {
        return Err(format!("there is no collision {number} until {end}: the last one is {found}").into());
    }
    write(&state).map(drop)
}

/// Returns the present state, encoded in the format that the ending of the file's name chooses.
fn contents<E: Experiment>(run: &mut Run<E>, path: Option<&Path>) -> Result<Vec<u8>, Failure> {
    let path = path.unwrap_or(Path::new("-.csv"));
    let Some(ending) = Ending::of(path) else { return Ok(run.checkpoint().to_bytes()?) };
    let text = ending.text(path, &State::of(&run.snapshot())).transpose()?;
    let advice = || PlanError::Refused(format!("`convert` makes {} of a file in .xyz", path.display()));
    text.ok_or_else(|| advice().into())
}
