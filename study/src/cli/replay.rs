//! The command `replay`, which runs a value again and writes its collisions, or the state before a collision.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;

use granular_edmd::observable::{Collision, Observer, Partner, on_collision};
use granular_edmd_files::State;

use super::arguments::Replay;
use super::convert::Ending;
use super::source::{HEADINGS, Source, row, tell_end};
use super::terminal::{end_at_once, wrote};
use super::{End, Failure, PlanError, StudyError};
use crate::execution::value::play::{Found, Pause, Player};
use crate::{Experiment, Run};

/// Default number of collisions to write.
const FEW: usize = 10;

/// Number of rows that are written at a time.
const BATCH: usize = 1024;

/// Runs a value again, and writes the requested collisions or the requested state. An incomplete file is
/// removed.
pub(super) fn replay<E: Experiment>(wishes: &Replay) -> Result<End, Failure> {
    let source = Source::<E>::open(&wishes.plan, &wishes.place)?;
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
    source: Source<E>,
    write: &mut impl FnMut(&[u8]) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let show = source.clock();
    let Source { run, found, end, .. } = source;
    let last = wishes.last.unwrap_or(if wishes.from.is_some() { usize::MAX } else { FEW });
    let caught = Rc::new(RefCell::new(VecDeque::new()));
    let value = found.as_ref().map(Found::value);
    let catcher = wishes.catcher::<E>(&run, last, Rc::clone(&caught));
    let mut player = Player::new(value.as_ref(), run, catcher)?;
    let (mut kept, mut text) = (VecDeque::new(), HEADINGS.to_owned() + "\n");
    loop {
        let paused = player.play(end, u64::MAX);
        let boundary = player.run().boundary();
        kept.extend(caught.borrow_mut().drain(..).map(|(number, it)| row(number, &it, boundary) + "\n"));
        kept.drain(..kept.len().saturating_sub(last));
        show(player.run().time());
        let is_over = !matches!(paused, Ok(Pause::Slice));
        // If the run ends with an error, the collisions before the error are still written.
        if let Err(error) = paused {
            tell_end(player.run(), &*error);
        }
        if is_over || (last == usize::MAX && kept.len() >= BATCH) {
            text.extend(kept.drain(..));
            if !write(text.as_bytes())? || is_over {
                return Ok(());
            }
            text.clear();
        }
    }
}

impl Replay {
    /// Returns an observer that catches the last of the requested collisions, with their numbers.
    fn catcher<E: Experiment>(
        &self,
        start: &Run<E>,
        last: usize,
        caught: Rc<RefCell<VecDeque<(u64, Collision)>>>,
    ) -> Box<dyn Observer> {
        let (mut number, disk) = (start.counters().collisions(), self.disk);
        let from = self.from.filter(|from| *from > start.time());
        let is_of = |it: &Collision, id| {
            it.ids[0] == id || (matches!(it.partner, Partner::Disk(_)) && it.ids[1] == id)
        };
        Box::new(on_collision(move |it: &Collision| {
            number += 1;
            if from.is_none_or(|from| it.time > from) && disk.is_none_or(|id| is_of(it, id)) {
                let mut caught = caught.borrow_mut();
                caught.push_back((number, *it));
                let more = caught.len().saturating_sub(last);
                caught.drain(..more);
            }
        }))
    }
}

/// Writes the state before a collision, even if the collision ended the run with an error.
fn state_before<E: Experiment>(
    number: u64,
    source: Source<E>,
    path: Option<&Path>,
    write: &mut impl FnMut(&[u8]) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let show = source.clock();
    let Source { run, found, end, .. } = source;
    let first = run.counters().collisions() + 1;
    if number < first {
        let message = format!("the first collision of this run has the number {first}, not {number}");
        return Err(PlanError::Refused(message).into());
    }
    let absent = |last| format!("there is no collision {number} until {end}: the last one is {last}").into();
    let value = found.as_ref().map(Found::value);
    let mut player = Player::new(value.as_ref(), run, Box::new(()))?;
    let ended = loop {
        match player.play(end, number - 1) {
            Ok(Pause::Slice) => show(player.run().time()),
            ended => break ended,
        }
    };
    let found = player.run().counters().collisions();
    if found + 1 < number {
        ended?;
        return Err(absent(found));
    }
    let state = contents::<E>(player.run(), path)?;
    // The run may end without a further collision.
    let is_there = ended.is_err()
        || loop {
            match player.play(end, number) {
                Ok(Pause::Slice) => {}
                last => break last.is_err() || player.run().counters().collisions() == number,
            }
        };
    if is_there { write(&state).map(drop) } else { Err(absent(found)) }
}

/// Returns the present state, encoded in the format that the ending of the file's name chooses.
fn contents<E: Experiment>(run: &Run<E>, path: Option<&Path>) -> Result<Vec<u8>, Failure> {
    let path = path.unwrap_or(Path::new("-.csv"));
    let Some(ending) = Ending::of(path) else { return Ok(run.checkpoint().to_bytes()?) };
    let text = ending.text(path, &State::of(&run.snapshot())).transpose()?;
    let advice = || PlanError::Refused(format!("`convert` makes {} of a file in .xyz", path.display()));
    text.ok_or_else(|| advice().into())
}
