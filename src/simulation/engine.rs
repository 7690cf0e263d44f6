//! The two halves of a simulation: the parts that its user chooses, and the engine that they drive.

use super::cells::Cells;
use super::lookahead::Lookahead;
use super::state::{Bodies, Clock, Ledger};
use super::{Counters, Inlet};
#[cfg(debug_assertions)]
use crate::Gravity;
use crate::instructions::Instructions;
use crate::observable::Mark;

/// The parts that may be of any type.
#[derive(Debug, Clone)]
pub(super) struct Parts<R, B, S> {
    pub(super) rule: R,
    pub(super) boundary: B,
    pub(super) scheduler: S,
}

/// The state of a simulation, which is the same type for all parts.
#[derive(Debug, Clone)]
pub(super) struct Engine {
    /// Number of walls of the boundary. The results of the boundary are checked against this number.
    pub(super) wall_count: usize,
    pub(super) bodies: Bodies,
    pub(super) cells: Cells,
    pub(super) clock: Clock,
    /// Seed of the stochastic walls.
    pub(super) seed: u64,
    pub(super) counters: Counters,
    pub(super) lookahead: Lookahead,
    /// Processor instructions that predictions may use. The results are the same with any of them, bit for
    /// bit.
    pub(super) instructions: Instructions,
    pub(super) scratch: Scratch,
    pub(super) inlets: Vec<Inlet>,
    pub(super) ledger: Ledger,
    /// The last wall with a mass from which a stop took energy, and the energy that stops have absorbed since
    /// the last change between two runs.
    pub(super) stopped: Option<(usize, f64)>,
    /// The names of the walls with a mass that were hit since then, and the energy that each had after its
    /// last hit. The sides of a part have one name and one energy.
    pub(super) energies_of_walls: Vec<(String, f64)>,
    /// Marks of this run and of its walls.
    pub(super) marks: [Mark; 2],
}

impl Engine {
    /// Creates an engine for these bodies, which has not run yet.
    pub(super) fn new(
        wall_count: usize,
        bodies: Bodies,
        cells: Cells,
        clock: Clock,
        seed: u64,
        ledger: Ledger,
    ) -> Self {
        Self {
            wall_count,
            bodies,
            cells,
            clock,
            seed,
            counters: Counters::default(),
            lookahead: Lookahead::default(),
            instructions: Instructions::detected(),
            scratch: Scratch::default(),
            inlets: Vec::new(),
            ledger,
            stopped: None,
            energies_of_walls: Vec::new(),
            marks: [Mark::new(), Mark::new()],
        }
    }

    /// Returns the present absolute time.
    #[inline]
    pub(super) fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Returns the number of disks.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Notes that a stop has absorbed this energy of a wall with a mass.
    pub(super) fn note_stop(&mut self, wall: usize, energy: f64) {
        self.stopped = Some((wall, energy + self.stopped.map_or(0.0, |(_, before)| before)));
    }

    /// Notes the energy of a wall with a mass before and after a hit. Between two hits, only a stop takes
    /// energy from it; less than this share is rounding.
    pub(super) fn note_energies(&mut self, wall: usize, name: &str, [before, after]: [f64; 2]) {
        let known = self.energies_of_walls.iter_mut().find(|(other, _)| *other == name);
        let Some((_, energy)) = known else { return self.energies_of_walls.push((name.to_owned(), after)) };
        let lost = std::mem::replace(energy, after) - before;
        if lost > 1e-12 * before.abs() {
            self.note_stop(wall, lost);
        }
    }

    /// Returns an engine without disks, which stands in for one that is lent.
    #[cfg(debug_assertions)]
    pub(super) fn empty() -> Self {
        let bodies = Bodies::new(&[], Gravity::NONE);
        let (clock, ledger) = (Clock::new(0.0, 1.0), Ledger::new(0.0, 0.0));
        Self::new(0, bodies, Cells::default(), clock, 0, ledger)
    }
}

/// An engine as a simulation holds it: builds with debug assertions lend it (`lending.rs`), and then move
/// only a pointer.
#[cfg(debug_assertions)]
pub(super) type Held = Box<Engine>;
#[cfg(not(debug_assertions))]
pub(super) type Held = Engine;

/// Buffers that are used again and again.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    /// Buffers for the neighbors of one disk, or of both disks of a collision.
    pub(super) found: [Vec<u32>; 2],
    /// Times of the next events of all disks.
    pub(super) due: Vec<f64>,
    /// Number of disks for which the scheduler has room.
    pub(super) seats: usize,
    /// Number of events and time at which all disks were last checked after a run.
    pub(super) checked: Option<(u64, f64)>,
}
