//! The commands that play a value again, from its start or from a file: `replay` writes its collisions,
//! `trajectory` writes frames.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::error::Error;
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
use granular_edmd::simulation::{Checkpoint, CheckpointError, RunError};
use granular_edmd_files::{ByEnding, Reader, Recorder};

use super::arguments::{Place, Replay, Trajectory};
use super::convert::Ending;
use super::{End, Failure, Watch, chain, end_at_once, read, say, tell, wrote};
use crate::execution::value::play::{Found, Pause, Player};
use crate::{Experiment, ExperimentError, Plan, PlanError, Progress, Run, Scalar, Study, StudyError};

/// A run at its start.
struct Source<E: Experiment> {
    run: Run<E>,
    /// The value that the run belongs to; `None` if the run starts from a file.
    found: Option<Found<E>>,
    cycle: f64,
    /// Time at which the run ends.
    end: f64,
}

impl<E: Experiment> Source<E> {
    /// Opens a value of a plan, or of the study in a folder, at its start.
    fn open(path: &Path, place: &Place) -> Result<Self, Failure> {
        let source = match &place.start {
            Some(file) => Self::from_file(path, place, file)?,
            None => Self::of_value(path, place)?,
        };
        let (start, end, until) = (source.run.time(), source.end, place.until.unwrap_or(source.end));
        if until > start && until <= end {
            return Ok(Self { end: until, ..source });
        }
        let message = format!("the run starts at {start} and ends at {end}: it cannot go until {until}");
        Err(PlanError::Refused(message).into())
    }

    fn of_value(path: &Path, &Place { ramp, value, .. }: &Place) -> Result<Self, Failure> {
        let found = if path.is_dir() {
            Study::open(path)?.find(ramp, value)?
        } else {
            let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
            plan.experiment(ramp, value)?;
            if value > 0 {
                let source = "it starts where another one ended: `run` the plan, and give the folder".into();
                return Err(StudyError::Build { ramp, value, source }.into());
            }
            Found::first(path, plan, ramp)?
        };
        let ((run, end), cycle) = (found.start()?, found.experiment().cycle());
        Ok(Self { run, found: Some(found), cycle, end })
    }

    fn from_file(path: &Path, &Place { ramp, value, .. }: &Place, file: &Path) -> Result<Self, Failure> {
        // A study knows the times of the value, unless others before it are still to be done. A start file
        // needs only the plan, so nothing else about the folder is an error here.
        let study = if path.is_dir() { Study::<E>::open(path).ok() } else { None };
        let known = study.and_then(|study| study.find(ramp, value).ok()?.start().ok());
        let path = if path.is_dir() { &path.join("plan.toml") } else { path };
        let plan = Plan::<E>::from_toml(&read(path)?).map_err(StudyError::unreadable(path))?;
        let (experiment, seed) = (plan.experiment(ramp, value)?, plan.ramp_seed(ramp));
        let run = begun(&experiment, file, seed);
        let run = run.map_err(|source| StudyError::Build { ramp, value, source })?;
        let is_within = |(first, end): &(Run<E>, f64)| (first.time()..*end).contains(&run.time());
        let later = run.time() + plan.protocol().cycles() as f64 * experiment.cycle();
        let end = known.filter(is_within).map_or(later, |(_, end)| end);
        Ok(Self { run, found: None, cycle: experiment.cycle(), end })
    }

    /// Returns a display of the simulated time, in cycles.
    fn clock(&self) -> impl Fn(f64) + use<E> {
        let (watch, start, end, cycle) = (Watch::new(), self.run.time(), self.end, self.cycle);
        move |time| {
            let [done, total] = [time, end].map(|time| ((time - start) / cycle) as u64);
            watch.show(&Progress { ramp: 0, value: 0, done, total });
        }
    }
}

/// Starts from a file: a checkpoint, or disks.
fn begun<E: Experiment>(experiment: &E, path: &Path, seed: u64) -> Result<Run<E>, ExperimentError> {
    if experiment.driving(seed)?.is_some() {
        return Err("its driving is not in a file, so it cannot start from one".into());
    }
    let (rule, boundary) = (experiment.rule()?, experiment.boundary()?);
    let state = match Checkpoint::read(path) {
        Err(error) if is_no_checkpoint(&error) => Reader::new().read(path)?,
        checkpoint => {
            let run = Simulation::resume(&checkpoint?, rule, boundary).build()?;
            let is_same = run.gravity() == experiment.gravity();
            return if is_same { Ok(run) } else { Err("the checkpoint has another gravity".into()) };
        }
    };
    for note in state.notes() {
        tell(&note);
    }
    if state.domain().is_some_and(|domain| domain != boundary.domain()) {
        tell(&format!("{} is of another box", path.display()));
    }
    if state.gravity().is_some_and(|gravity| gravity != experiment.gravity()) {
        tell(&format!("{} has another gravity; the run takes the gravity of the plan", path.display()));
    }
    let builder = Simulation::builder(rule, boundary).gravity(experiment.gravity());
    let builder = builder.starting_at(state.time().unwrap_or(0.0)).seed(seed);
    Ok(builder.disks(state.into_disks()).build()?)
}

/// Returns whether a file is not a checkpoint or cannot be read. In the second case, the reader of disks
/// gives a better error.
fn is_no_checkpoint(error: &CheckpointError) -> bool {
    match error {
        CheckpointError::File { source, .. } => matches!(**source, CheckpointError::NotACheckpoint),
        error => matches!(error, CheckpointError::Io { .. }),
    }
}

/// Prints the error with which a run ended. The id of the disk is added, since errors name disks by index and
/// tables by id.
fn tell_end<R: CollisionRule, B: Boundary>(run: &Simulation<R, B>, error: &(dyn Error + 'static)) {
    let id = match error.downcast_ref() {
        Some(RunError::Stalled { disk, .. } | RunError::FalseContact { disk, .. }) => run.disk(*disk),
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
pub(super) fn trajectory<E: Experiment>(wishes: &Trajectory) -> Result<End, Failure> {
    let Trajectory { plan, out, place, cycles } = wishes;
    Ending::need(out, Ending::is_trajectory)?;
    let Source { run, found, cycle, .. } = Source::<E>::open(plan, place)?;
    let (times, count) = (SampleTimes::every(cycle)?, Rc::new(Cell::new(0)));
    let (recorder, counted) = (Recorder::create(out, ByEnding, times)?, Rc::clone(&count));
    let counter = on_sample(times, move |_: &Snapshot<'_>| counted.set(counted.get() + 1));
    // The run lasts half a cycle longer, so that rounding cannot lose the last frame.
    let end = run.time() + cycle * (f64::from(*cycles) + 0.5);
    let end = place.until.map_or(end, |until| end.min(until));
    let value = found.as_ref().map(Found::value);
    let mut player = Player::new(value.as_ref(), run, Box::new((recorder, counter)))?;
    play(&mut player, end)?;
    if player.is_over() && !player.is_driven() {
        player = player.beyond();
        play(&mut player, end)?;
    }
    let (frames, disks) = (count.get(), player.run().len());
    if player.is_over() && frames < *cycles {
        tell(&format!(
            "the value ended at {}; without its driving, the run cannot go on",
            player.run().time()
        ));
    }
    say(&format!("{frames} frames of {disks} disks are in {}", out.display()))?;
    Ok(End::Done)
}

/// Plays until a time or the end of the value.
fn play<E: Experiment>(player: &mut Player<'_, E>, until: f64) -> Result<(), Failure> {
    while player.play(until)? == Pause::Slice {}
    Ok(())
}

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
    let written = rows(wishes, source, &mut write);
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
        let paused = player.play(end);
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
