//! One run of a study: its blocks of ramps, for all threads and processes, and the data that they share.

use std::collections::{BTreeSet, HashMap, VecDeque};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::{Control, Progress, Summary};
use crate::parameters::{self, anywhere};
use crate::store::Head;
use crate::{Difference, Experiment, Plan, PlanError, Study, StudyError};

/// Longest time between two checks in which a thread looks for a request to stop.
pub(super) const LOOK: Duration = Duration::from_millis(200);

/// The state that the threads of one [`Study::run`] share.
pub(super) struct Session<'a, E: Experiment> {
    pub(super) study: &'a Study<E>,
    pub(super) control: &'a Control<'a>,
    /// Earlier studies, each with the indices of its ramps by seed.
    earlier: Vec<(Study<E>, HashMap<u64, usize>)>,
    blocks: Mutex<Blocks>,
    /// The ramps to be run.
    pub(super) ramps: Range<usize>,
    /// Number of finished steps, and number of steps in all values.
    steps: [AtomicU64; 2],
    /// Files that were damaged and have been replaced.
    redone: Mutex<BTreeSet<PathBuf>>,
    /// True once a thread has met an error.
    ///
    /// The others then stop as if interrupted.
    pub(super) broken: AtomicBool,
    /// True once this run has removed the mark of a complete study.
    pub(super) is_opened: AtomicBool,
}

impl<'a, E: Experiment> Session<'a, E> {
    pub(super) fn new(
        study: &'a Study<E>,
        control: &'a Control<'a>,
        ramps: Range<usize>,
    ) -> Result<Self, StudyError> {
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
    pub(super) fn strike_done(&self) -> Result<(), StudyError> {
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
    pub(super) fn ramps_of(&self, block: usize) -> impl Iterator<Item = usize> {
        self.study.store.ramps_of(block).filter(|ramp| self.ramps.contains(ramp))
    }

    pub(super) fn is_done(&self, block: usize) -> bool {
        self.ramps_of(block).all(|ramp| self.study.store.is_done(ramp))
    }

    pub(super) fn blocks(&self) -> MutexGuard<'_, Blocks> {
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the ramps of earlier studies that have this seed.
    pub(super) fn earlier_ramps(&self, seed: u64) -> Vec<(&Study<E>, usize)> {
        self.earlier.iter().filter_map(|(study, ramps)| Some((study, *ramps.get(&seed)?))).collect()
    }

    /// Counts the steps of finished ramps.
    pub(super) fn skip(&self, ramps: usize) {
        let plan = self.study.plan();
        let steps = (ramps * plan.value_count()) as u64 * plan.protocol().steps();
        self.steps[0].fetch_add(steps, Ordering::Relaxed);
    }

    /// Counts a value that a refinement adds.
    pub(super) fn count_more(&self) {
        self.steps[1].fetch_add(self.study.plan().protocol().steps(), Ordering::Relaxed);
    }

    /// Counts steps of a value, and reports the progress.
    pub(super) fn advance(&self, ramp: usize, value: usize, steps: u64) {
        let done = self.steps[0].fetch_add(steps, Ordering::Relaxed) + steps;
        if let Some(progress) = self.control.progress {
            progress(&Progress { ramp, value, done, total: self.steps[1].load(Ordering::Relaxed) });
        }
    }

    /// Returns the data that were read. If the file is damaged, notes it and returns `None`.
    pub(super) fn if_sound<T>(&self, read: Result<Option<T>, StudyError>) -> Result<Option<T>, StudyError> {
        match read {
            Err(StudyError::Damaged { path, .. }) => {
                self.redone.lock().unwrap_or_else(PoisonError::into_inner).insert(path);
                Ok(None)
            }
            other => other,
        }
    }

    pub(super) fn must_stop(&self) -> bool {
        self.control.interrupt.is_some_and(|stop| stop.load(Ordering::Relaxed))
            || self.broken.load(Ordering::Relaxed)
    }

    /// Sleeps for this time, or until the run must stop.
    pub(super) fn sleep(&self, time: Duration) {
        let start = Instant::now();
        while start.elapsed() < time && !self.must_stop() {
            std::thread::sleep(LOOK.min(time.saturating_sub(start.elapsed())));
        }
    }

    /// Returns the summary of the run.
    pub(super) fn summary(self) -> Result<Summary, StudyError> {
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
pub(super) struct Blocks {
    pub(super) waiting: VecDeque<usize>,
    pub(super) elsewhere: VecDeque<usize>,
}

impl Blocks {
    /// Notes that another process has a block, and moves to another waiting block.
    pub(super) fn leave(&mut self, block: usize) {
        self.elsewhere.push_back(block);
        self.waiting = begun_anywhere(std::mem::take(&mut self.waiting));
    }

    /// Moves up to `count` blocks of other processes to the waiting blocks, for another attempt.
    pub(super) fn retry(&mut self, count: usize) {
        let mut tried = begun_anywhere(std::mem::take(&mut self.elsewhere));
        self.elsewhere = tried.split_off(count.min(tried.len()));
        self.waiting.append(&mut tried);
    }
}

/// Rotates the blocks so that they begin at a random one.
fn begun_anywhere(mut blocks: VecDeque<usize>) -> VecDeque<usize> {
    blocks.rotate_left(anywhere(blocks.len()));
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
