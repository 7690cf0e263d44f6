//! The commands that play a value again: `replay` writes its collisions, `trajectory` writes frames.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;

use granular_edmd::Simulation;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::{CollisionRule, Regime};
use granular_edmd::observable::{
    Collision, Observer, Partner, SampleTimes, Snapshot, on_collision, on_sample,
};
use granular_edmd::simulation::RunError;
use granular_edmd_files::{ByEnding, Recorder};

use super::arguments::{Place, Replay, Trajectory};
use super::convert::Ending;
use super::{Failure, Watch, chain, end_at_once, read, say, tell, wrote};
use crate::execution::value::Value;
use crate::folder::Folder;
use crate::{Experiment, Plan, PlanError, Progress, Run, Scalar, Study, StudyError};

/// Opens the study in a folder, or a study of a plan, which has no folder.
fn study<E: Experiment>(path: &Path, &Place { ramp, value, .. }: &Place) -> Result<Study<E>, Failure> {
    if path.is_dir() {
        return Ok(Study::open(path)?);
    }
    let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
    plan.experiment(ramp, value)?;
    if value > 0 {
        let source = "it starts where another one ended: `run` the plan, and give the folder".into();
        return Err(StudyError::Build { ramp, value, source }.into());
    }
    // A study reads and writes its folder only when it is asked to.
    Ok(Study::in_folder(Folder::new(path)?, plan)?)
}

/// A value at its start.
struct Source<'a, E: Experiment> {
    value: Value<'a, E>,
    run: Run<E>,
    /// Time at which the run ends.
    end: f64,
}

impl<'a, E: Experiment> Source<'a, E> {
    fn of(study: &'a Study<E>, &Place { ramp, value, until }: &Place) -> Result<Self, Failure> {
        let is_saved = study.folder().is_dir();
        let value = if is_saved { study.find(ramp, value)? } else { study.first(ramp)? };
        let (run, end) = value.at_start()?;
        let (start, until) = (run.time(), until.unwrap_or(end));
        if until > start && until <= end {
            return Ok(Self { value, run, end: until });
        }
        let message = format!("the run starts at {start} and ends at {end}: it cannot go until {until}");
        Err(PlanError::Refused(message).into())
    }

    /// Returns a display of the simulated time, in cycles.
    fn clock(&self) -> impl Fn(f64) + use<E> {
        let cycle = self.value.experiment.cycle();
        let (watch, start, end) = (Watch::new(), self.run.time(), self.end);
        move |time| {
            let [done, total] = [time, end].map(|time| ((time - start) / cycle) as u64);
            watch.show(&Progress { ramp: 0, value: 0, done, total });
        }
    }
}

/// Prints the error with which a run ended. The id of the disk is added, since errors name disks by index and
/// tables by id.
fn tell_end<R: CollisionRule, B: Boundary>(run: &Simulation<R, B>, error: &RunError) {
    let id = match error {
        RunError::Stalled { disk, .. } | RunError::FalseContact { disk, .. } => run.disk(*disk),
        _ => None,
    };
    let id = id.map_or_else(String::new, |disk| format!("; that disk has the id {}", disk.id()));
    tell(&format!("the run ended: {}{id}", chain(error)));
}

/// Names of the columns of a table of collisions.
const HEADINGS: &str = "number,time,disk,partner,wall,x,y,closing_speed,slip_speed,normal_impulse,\
                                   tangential_impulse,energy_change,regime";

/// Returns a collision as a row.
fn row(number: u64, it: &Collision, boundary: &impl Boundary) -> String {
    let [id, partner] = it.ids;
    let (partner, wall) = match it.partner {
        Partner::Wall(wall) => (String::new().into(), boundary.wall(wall, 0.0).to_string()),
        Partner::Disk(_) => (Scalar::from(partner), String::new()),
    };
    let (contact, impulse) = (&it.contact, &it.impulse);
    let [x, y, time] = [it.position.x, it.position.y, it.time].map(Scalar::from);
    let speeds = [contact.closing_speed(), contact.slip_speed()];
    let changes = [impulse.normal(), impulse.tangential(), it.energy_change];
    let regime = Some(impulse.regime()).filter(|regime| *regime != Regime::Unspecified);
    let regime = regime.map_or_else(String::new, |regime| format!("{regime:?}"));
    let cells = [number.into(), time, id.into(), partner, wall.into(), x, y].into_iter();
    let cells = cells.chain(speeds.into_iter().chain(changes).map(Scalar::from)).chain([regime.into()]);
    cells.map(|cell| cell.to_string()).collect::<Vec<_>>().join(",")
}

/// Runs a value again, and writes a frame after each cycle.
pub(super) fn trajectory<E: Experiment>(wishes: &Trajectory) -> Result<(), Failure> {
    let Trajectory { plan, out, place, cycles } = wishes;
    Ending::need(out, Ending::is_trajectory)?;
    let study = study::<E>(plan, place)?;
    let Source { value, run, end } = Source::of(&study, place)?;
    let (cycle, disks) = (value.experiment.cycle(), run.len());
    let (times, count) = (SampleTimes::every(cycle)?, Rc::new(Cell::new(0)));
    let (recorder, counted) = (Recorder::create(out, ByEnding, times)?, Rc::clone(&count));
    let counter = on_sample(times, move |_: &Snapshot<'_>| counted.set(counted.get() + 1));
    // The run lasts half a cycle longer, so that rounding cannot lose the last frame.
    let end = end.min(run.time() + cycle * (f64::from(*cycles) + 0.5));
    let mut played = value.played(run, Box::new((recorder, counter)))?;
    while played.play(end)? {}
    say(&format!("{} frames of {disks} disks are in {}", count.get(), out.display()))
}

/// Default number of collisions to write.
const FEW: usize = 10;

/// Number of rows that are written at a time.
const BATCH: usize = 1024;

/// Runs a value again, and writes the requested collisions or the requested state. An incomplete file is
/// removed.
pub(super) fn replay<E: Experiment>(wishes: &Replay) -> Result<(), Failure> {
    let study = study::<E>(&wishes.plan, &wishes.place)?;
    let source = Source::of(&study, &wishes.place)?;
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
    let written = rows(wishes, source, &mut write);
    if let (Some(path), Err(_)) = (&wishes.out, &written) {
        let _ = fs::remove_file(path);
    }
    written
}

impl Replay {
    /// Returns an error if the run ends before `--from`, or cannot contain the disk of `--disk`.
    fn check<E: Experiment>(&self, Source { run, end, .. }: &Source<'_, E>) -> Result<(), PlanError> {
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
    source: Source<'_, E>,
    write: &mut impl FnMut(&[u8]) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let show = source.clock();
    let Source { value, run, end } = source;
    let last = wishes.last.unwrap_or(if wishes.from.is_some() { usize::MAX } else { FEW });
    let caught = Rc::new(RefCell::new(VecDeque::new()));
    let catcher = wishes.catcher::<E>(&run, last, Rc::clone(&caught));
    let mut played = value.played(run, catcher)?;
    let (mut kept, mut text) = (VecDeque::new(), HEADINGS.to_owned() + "\n");
    loop {
        let paused = played.play(end);
        let boundary = played.run().boundary();
        kept.extend(caught.borrow_mut().drain(..).map(|(number, it)| row(number, &it, boundary) + "\n"));
        kept.drain(..kept.len().saturating_sub(last));
        show(played.run().time());
        let is_over = !matches!(paused, Ok(true));
        // If the run ends with an error, the collisions before the error are still written.
        if let Err(error) = paused {
            tell_end(played.run(), &error);
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
