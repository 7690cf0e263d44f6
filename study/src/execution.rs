//! Runs of a study, which compute the missing values; and the controls that watch and stop a run.

mod ramp;
pub(super) mod value;

use std::collections::{BTreeSet, HashMap, VecDeque};
use std::fmt;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use granular_edmd::ParameterError;
use granular_edmd::quantity::positive;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::parameters;
use super::store::Head;
use super::{Difference, Experiment, Plan, PlanError, Study, StudyError};

/// Shortest and longest time between two checks of the work of other processes. The time doubles from check
/// to check, since a process that waits must not burden a file system that other processes need.
const PATIENCE: [Duration; 2] = [Duration::from_millis(50), Duration::from_secs(5)];

/// Largest number of blocks of other processes that one check tries to take over.
const TRIED: usize = 8;

/// Progress of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Index of the ramp that has just made progress.
    pub ramp: usize,
    /// Index of the value in the ramp.
    pub value: usize,
    /// Number of finished steps in all ramps; a step is about one sampling interval.
    pub done: u64,
    /// Number of all steps of the ramps to be run, whether finished or not.
    pub total: u64,
}

/// Options of a run: how to watch it, stop it, save it and limit it. Only
/// [`with_most_seconds`](Self::with_most_seconds) influences results.
///
/// ```
/// use granular_edmd_study::{Control, Progress};
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// let stop = AtomicBool::new(false);
/// let show = |progress: &Progress| eprintln!("{} of {}", progress.done, progress.total);
/// let control = Control::default().with_progress(&show).with_interrupt(&stop);
/// # let _ = control;
/// ```
#[derive(Clone, Copy)]
pub struct Control<'a> {
    progress: Option<&'a (dyn Fn(&Progress) + Sync)>,
    interrupt: Option<&'a AtomicBool>,
    earlier: &'a [PathBuf],
    save_interval: Duration,
    most_seconds: Option<f64>,
    waits: bool,
    writes_tables: bool,
    verifies: bool,
}

impl Default for Control<'_> {
    /// Creates the control of a run that is neither watched nor stopped. The run saves unfinished values
    /// every minute, and waits for ramps that other processes run.
    fn default() -> Self {
        Self {
            progress: None,
            interrupt: None,
            earlier: &[],
            save_interval: Duration::from_secs(60),
            most_seconds: None,
            waits: true,
            writes_tables: true,
            verifies: false,
        }
    }
}

impl<'a> Control<'a> {
    /// Returns the same control, which calls `progress` after every step, in the thread that ran the step.
    pub fn with_progress(self, progress: &'a (dyn Fn(&Progress) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Returns the same control, which saves all work and stops within a second after `interrupt` becomes
    /// true, however long a sampling interval takes.
    ///
    /// A very large system takes longer to save, and a run cannot be stopped while it sets up a system.
    pub fn with_interrupt(self, interrupt: &'a AtomicBool) -> Self {
        Self { interrupt: Some(interrupt), ..self }
    }

    /// Returns the same control, which reuses finished values of the earlier studies in these folders.
    ///
    /// In this way, a larger study in a new folder reuses a smaller one, or the parts of a sweep become one
    /// study. The plans may differ in the values of their axes and in the number of repeats. Ramps of the new
    /// plan may have more values at their end. If the new plan has more samples, an old value is continued
    /// from its end, provided that the value's record keeps the state
    /// ([`Plan::with_end_states`](crate::Plan::with_end_states)). Any other difference is an error. The files
    /// of the new study have the same bytes as without the earlier studies. Values that other code made are
    /// computed again, even if an earlier study accepted this code.
    #[doc(alias("grow", "merge", "extend"))]
    pub fn with_earlier_studies(self, folders: &'a [PathBuf]) -> Self {
        Self { earlier: folders, ..self }
    }

    /// Returns the same control, which saves unfinished values after each interval of this length.
    ///
    /// A process that is killed loses no more than the work since the last save.
    #[doc(alias = "checkpoint")]
    pub fn with_save_interval(self, interval: Duration) -> Self {
        Self { save_interval: interval, ..self }
    }

    /// Returns the same control, which ends each value that takes more than this wall-clock time, with
    /// [`Outcome::Limited`](crate::Outcome::Limited).
    ///
    /// The values that end in this way depend on the machine. Such a value counts as failed, and its record
    /// stays until [`Study::forget_failed`](crate::Study::forget_failed). A limit that gives the same result
    /// everywhere is [`Protocol::with_most_collisions`](crate::Protocol::with_most_collisions). After an
    /// interruption, only the time since the value was resumed counts.
    ///
    /// # Errors
    /// If the time is not positive.
    pub fn with_most_seconds(self, seconds: f64) -> Result<Self, ParameterError> {
        Ok(Self { most_seconds: Some(positive("most seconds for a value", seconds)?), ..self })
    }

    /// Returns the same control without waiting for ramps that other processes run.
    ///
    /// The run then returns as soon as only ramps of other processes are left. [`Summary::elsewhere`] lists
    /// these ramps, since the other processes may yet be killed.
    pub fn without_waiting(self) -> Self {
        Self { waits: false, ..self }
    }

    /// Returns the same control, which writes no tables when all ramps are done.
    ///
    /// [`Study::write_tables`](crate::Study::write_tables) writes them later.
    pub fn without_tables(self) -> Self {
        Self { writes_tables: false, ..self }
    }

    /// Returns the same control, which also reads the records of finished ramps, and runs the values of
    /// damaged or lost records again. The verification reads the whole study.
    pub fn with_verification(self) -> Self {
        Self { verifies: true, ..self }
    }
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Control");
        debug.field("interrupt", &self.interrupt).field("save_interval", &self.save_interval);
        debug.finish_non_exhaustive()
    }
}

/// The summary of a run of a study.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Summary {
    /// Number of values that have a record now.
    pub finished: usize,
    /// Number of values that were not finished: they stalled, failed, or reached a limit. Such values have
    /// fewer samples, or no sample; [`Outcome::reason`](crate::Outcome::reason) says why.
    pub failed: usize,
    /// Number of values whose runs have [warnings](crate::Record::warnings).
    pub warned: usize,
    /// Number of values in the ramps to be run: all ramps of the study, or one ramp.
    pub total: usize,
    /// Ramps that other processes are running.
    pub elsewhere: Vec<usize>,
    /// Files that were damaged and have been replaced.
    pub redone: Vec<PathBuf>,
}

impl Summary {
    /// Returns true if all ramps to be run are complete.
    pub const fn is_complete(&self) -> bool {
        self.finished == self.total
    }
}

impl<E: Experiment> Study<E> {
    /// Runs all values that have no record yet, and writes the tables.
    ///
    /// Any number of processes may call this and [`Self::run_ramp`] at the same time; each ramp is run by one
    /// of them. A run waits for ramps of other processes, and takes over the ramps of a process that was
    /// killed. The run computes ramps in parallel, in the `rayon` thread pool from which this method is
    /// called. A run that is interrupted returns with all work saved. The next run continues from there, with
    /// the same result.
    ///
    /// # Errors
    /// If the plan or the code of the study has changed, files cannot be read or written, or a value cannot
    /// be started.
    pub fn run(&self, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.run_ramps(0..self.plan.ramp_count(), control)
    }

    /// Runs the values of one ramp that have no record yet, and writes the tables if all other ramps are
    /// done.
    ///
    /// This method is for batch engines that give each ramp to one process. In a study of more than 960
    /// ramps, the process waits while another one runs ramp K ± 960, K ± 1920 and so on, which have the same
    /// log.
    ///
    /// # Errors
    /// The same as for [`Self::run`], and if there is no such ramp.
    pub fn run_ramp(&self, ramp: usize, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_ramp(ramp)?;
        self.run_ramps(ramp..ramp + 1, control)
    }

    fn run_ramps(&self, ramps: Range<usize>, control: &Control<'_>) -> Result<Summary, StudyError> {
        self.check_unchanged()?;
        let is_whole = ramps.len() == self.plan().ramp_count();
        let session = Session::new(self, control, ramps)?;
        run_blocks(&session)?;
        let summary = session.summary()?;
        let is_done = || (0..self.plan.ramp_count()).all(|ramp| self.store.is_done(ramp));
        if control.writes_tables && summary.is_complete() && is_done() {
            self.write_tables_once(is_whole)?;
        }
        Ok(summary)
    }

    /// Writes the tables, unless another process has written them in between. A run of the whole study also
    /// writes lost tables again. A run of one ramp does not, if the study is marked as complete.
    fn write_tables_once(&self, is_whole: bool) -> Result<(), StudyError> {
        let is_there = || if is_whole { self.has_tables() } else { self.folder.complete().exists() };
        if is_there() {
            return Ok(());
        }
        let _lock = self.folder.lock()?;
        if is_there() {
            return Ok(());
        }
        self.write_locked().map(drop)
    }
}

/// Runs blocks until all are finished by this process or others. Blocks of other processes are left if the
/// control does not wait, or if the run must stop.
fn run_blocks<E: Experiment>(session: &Session<'_, E>) -> Result<(), StudyError> {
    session.strike_done()?;
    let mut patience = PATIENCE[0];
    loop {
        let threads = (0..rayon::current_num_threads()).into_par_iter().with_max_len(1);
        threads.try_for_each(|_| run_waiting(session))?;
        session.strike_done()?;
        if session.blocks().elsewhere.is_empty() || !session.control.waits || session.must_stop() {
            return Ok(());
        }
        session.sleep(patience);
        patience = PATIENCE[1].min(2 * patience);
        // The processes that run these blocks may have been killed.
        session.blocks().retry(TRIED);
    }
}

/// Runs the waiting blocks until none is left.
fn run_waiting<E: Experiment>(session: &Session<'_, E>) -> Result<(), StudyError> {
    while !session.must_stop() {
        let next = session.blocks().waiting.pop_front();
        let Some(block) = next else { break };
        if !ramp::attempt(session, block).inspect_err(|_| session.broken.store(true, Ordering::Relaxed))? {
            session.blocks().leave(block);
        }
    }
    Ok(())
}

/// Longest time between two checks in which a thread looks for a request to stop.
const LOOK: Duration = Duration::from_millis(200);

/// The state that the threads of one [`Study::run`] share.
struct Session<'a, E: Experiment> {
    study: &'a Study<E>,
    control: &'a Control<'a>,
    /// Earlier studies, each with the indices of its ramps by seed.
    earlier: Vec<(Study<E>, HashMap<u64, usize>)>,
    blocks: Mutex<Blocks>,
    /// The ramps to be run.
    ramps: Range<usize>,
    /// Number of finished steps, and number of steps in all values.
    steps: [AtomicU64; 2],
    /// Files that were damaged and have been replaced.
    redone: Mutex<BTreeSet<PathBuf>>,
    /// True once a thread has met an error.
    ///
    /// The others then stop as if interrupted.
    broken: AtomicBool,
    /// True once this run has removed the mark of a complete study.
    is_opened: AtomicBool,
}

impl<'a, E: Experiment> Session<'a, E> {
    fn new(study: &'a Study<E>, control: &'a Control<'a>, ramps: Range<usize>) -> Result<Self, StudyError> {
        let waiting = match ramps.len() {
            1 => VecDeque::from([study.store.block_of(ramps.start)]),
            _ => begun_anywhere((0..study.store.block_count()).collect()),
        };
        let open = |folder: &PathBuf| {
            let earlier = Study::open(folder)?;
            StudyError::if_different(folder, differences(&earlier.plan, &study.plan)?)?;
            earlier.store.refresh()?;
            let seeds = (0..earlier.plan.ramp_count()).map(|ramp| (earlier.plan.ramp_seed(ramp), ramp));
            let ramps = seeds.collect();
            Ok((earlier, ramps))
        };
        let values = (ramps.len() * study.plan().value_count()) as u64;
        Ok(Self {
            study,
            control,
            earlier: control.earlier.iter().map(open).collect::<Result<_, StudyError>>()?,
            blocks: Mutex::new(Blocks { waiting, elsewhere: VecDeque::new() }),
            ramps,
            steps: [0, values * study.plan().protocol().steps()].map(AtomicU64::new),
            redone: Mutex::default(),
            broken: AtomicBool::new(false),
            is_opened: AtomicBool::new(false),
        })
    }

    /// Removes the finished blocks. A verification keeps all blocks.
    fn strike_done(&self) -> Result<(), StudyError> {
        if self.control.verifies {
            return Ok(());
        }
        let mut ramps = 0;
        let Blocks { waiting, elsewhere } = &mut *self.blocks();
        for blocks in [waiting, elsewhere] {
            for block in std::mem::take(blocks) {
                self.study.store.refresh_block(block)?;
                if self.is_done(block) {
                    ramps += self.ramps_of(block).count();
                } else {
                    blocks.push_back(block);
                }
            }
        }
        self.skip(ramps);
        Ok(())
    }

    /// Returns the ramps of a block that are to be run.
    fn ramps_of(&self, block: usize) -> impl Iterator<Item = usize> {
        self.study.store.ramps_of(block).filter(|ramp| self.ramps.contains(ramp))
    }

    fn is_done(&self, block: usize) -> bool {
        self.ramps_of(block).all(|ramp| self.study.store.is_done(ramp))
    }

    fn blocks(&self) -> MutexGuard<'_, Blocks> {
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the ramps of earlier studies that have this seed.
    fn earlier_ramps(&self, seed: u64) -> Vec<(&Study<E>, usize)> {
        self.earlier.iter().filter_map(|(study, ramps)| Some((study, *ramps.get(&seed)?))).collect()
    }

    /// Counts the steps of finished ramps.
    fn skip(&self, ramps: usize) {
        let plan = self.study.plan();
        let steps = (ramps * plan.value_count()) as u64 * plan.protocol().steps();
        self.steps[0].fetch_add(steps, Ordering::Relaxed);
    }

    /// Counts a value that a refinement adds.
    fn count_more(&self) {
        self.steps[1].fetch_add(self.study.plan().protocol().steps(), Ordering::Relaxed);
    }

    /// Counts steps of a value, and reports the progress.
    fn advance(&self, ramp: usize, value: usize, steps: u64) {
        let done = self.steps[0].fetch_add(steps, Ordering::Relaxed) + steps;
        if let Some(progress) = self.control.progress {
            progress(&Progress { ramp, value, done, total: self.steps[1].load(Ordering::Relaxed) });
        }
    }

    /// Returns the data that were read. If the file is damaged, notes it and returns `None`.
    fn if_sound<T>(&self, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, .. }) => {
                self.redone.lock().unwrap_or_else(PoisonError::into_inner).insert(path);
                Ok(None)
            }
            other => other,
        }
    }

    fn must_stop(&self) -> bool {
        self.control.interrupt.is_some_and(|stop| stop.load(Ordering::Relaxed))
            || self.broken.load(Ordering::Relaxed)
    }

    /// Sleeps for this time, or until the run must stop.
    fn sleep(&self, time: Duration) {
        let start = Instant::now();
        while start.elapsed() < time && !self.must_stop() {
            std::thread::sleep(LOOK.min(time.saturating_sub(start.elapsed())));
        }
    }

    /// Returns the summary of the run.
    fn summary(self) -> Result<Summary, StudyError> {
        let store = &self.study.store;
        store.refresh()?;
        let elsewhere = std::mem::take(&mut self.blocks().elsewhere);
        let mut elsewhere: Vec<usize> =
            elsewhere.into_iter().flat_map(|block| self.ramps_of(block)).collect();
        elsewhere.retain(|ramp| !store.is_done(*ramp));
        elsewhere.sort_unstable();
        let values = self.study.plan().value_count();
        let found = || store.of(self.ramps.clone()).map(|entry| entry.head());
        let with = |mark| found().filter(|head| head.has(mark)).count();
        let finished = found().count();
        let more = found().filter(|head| head.value >= values).count();
        // If a ramp is not done, at least one value is missing, even if a refinement has yet to add this
        // value.
        let is_done = self.ramps.clone().all(|ramp| store.is_done(ramp));
        let total = (self.ramps.len() * values + more).max(finished + usize::from(!is_done));
        let (failed, warned) = (with(Head::FAILED), with(Head::WARNED));
        let redone = self.redone.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().collect();
        Ok(Summary { finished, failed, warned, total, elsewhere, redone })
    }
}

/// The blocks that are waiting to be run, and the blocks of other processes.
///
/// Each process begins at a random block and continues in order from there, so two processes seldom meet at a
/// block. A process that meets another one moves to a new random block.
#[derive(Debug)]
struct Blocks {
    waiting: VecDeque<usize>,
    elsewhere: VecDeque<usize>,
}

impl Blocks {
    /// Notes that another process has a block, and moves to another waiting block.
    fn leave(&mut self, block: usize) {
        self.elsewhere.push_back(block);
        self.waiting = begun_anywhere(std::mem::take(&mut self.waiting));
    }

    /// Moves up to `count` blocks of other processes to the waiting blocks, for another attempt.
    fn retry(&mut self, count: usize) {
        let mut tried = begun_anywhere(std::mem::take(&mut self.elsewhere));
        self.elsewhere = tried.split_off(count.min(tried.len()));
        self.waiting.append(&mut tried);
    }
}

/// Rotates the blocks so that they begin at a random one, which has no influence on results.
fn begun_anywhere(mut blocks: VecDeque<usize>) -> VecDeque<usize> {
    // The standard library seeds its hash tables from the operating system, so a random number needs no
    // dependency.
    let random = RandomState::new().build_hasher().finish();
    blocks.rotate_left(random.checked_rem(blocks.len() as u64).unwrap_or(0) as usize);
    blocks
}

/// Returns the fields in which two plans differ, except for fields that may differ in a larger study.
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
        let mut names = plan.varied[..plan.parts.sweep.len()].to_vec();
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
