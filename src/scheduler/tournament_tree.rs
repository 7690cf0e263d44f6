//! The scheduler for few disks: a tournament of their times.

mod earliest;
mod fours;
mod wide;

use super::EventScheduler;
use crate::instructions::{Instructions, Level};
use fours::Fours;
use wide::Wide;

/// A tournament: the earliest disk of each match enters the next round, until one disk is left.
///
/// Processors with vector instructions, which compare the times of four or eight disks together, play matches
/// of 32 disks. Other processors play matches of four, and with more than 32 768 disks, all do. The results
/// are the same.
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    instructions: Instructions,
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Fours(Fours),
    Two(Wide<2>),
    Three(Wide<3>),
}

impl Default for Form {
    fn default() -> Self {
        Self::Fours(Fours::new())
    }
}

impl TournamentTree {
    /// Creates a scheduler without disks.
    pub const fn new() -> Self {
        Self { instructions: Instructions::BUILT, form: Form::Fours(Fours::new()) }
    }
}

impl EventScheduler for TournamentTree {
    fn reset(&mut self, due: &[f64]) {
        self.instructions = Instructions::detected();
        let rounds = match due.len() {
            0 => 0,
            _ if self.instructions.level() == Level::Built => 0,
            disks if disks <= Wide::<2>::MOST_DISKS => 2,
            disks if disks <= Wide::<3>::MOST_DISKS => 3,
            _ => 0,
        };
        // A tree of the suitable form is kept, with its memory.
        match (&self.form, rounds) {
            (Form::Fours(_), 0) | (Form::Two(_), 2) | (Form::Three(_), 3) => {}
            (_, 2) => self.form = Form::Two(Wide::new()),
            (_, 3) => self.form = Form::Three(Wide::new()),
            _ => self.form = Form::default(),
        }
        match &mut self.form {
            Form::Fours(fours) => fours.reset(due),
            Form::Two(wide) => wide.reset(self.instructions, due),
            Form::Three(wide) => wide.reset(self.instructions, due),
        }
    }

    // The method is inlined, so that each event makes only one call: to the code for this processor.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn set(&mut self, disk: usize, due: f64) {
        match &mut self.form {
            Form::Fours(fours) => fours.set(disk, due),
            Form::Two(wide) => wide.set(self.instructions, disk, due),
            Form::Three(wide) => wide.set(self.instructions, disk, due),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn earliest(&self) -> (usize, f64) {
        match &self.form {
            Form::Fours(fours) => fours.earliest(),
            Form::Two(wide) => wide.earliest(),
            Form::Three(wide) => wide.earliest(),
        }
    }
}
