//! The scheduler for few disks: a tournament of their times.

mod earliest;
mod fours;
mod wide;

use super::EventScheduler;
use crate::instructions::{Instructions, Level};
use fours::Fours;
use wide::Wide;

/// A tournament: the earliest disk of each match goes on to the next round, until one is left.
///
/// On processors with vector instructions, a match has 32 disks, and otherwise four, as it has among more
/// than 32 768 disks.
#[derive(Debug, Clone, Default)]
pub struct TournamentTree {
    instructions: Instructions,
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Fours(Fours),
    /// Two rounds of matches of 32.
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

    fn reset_with(&mut self, instructions: Instructions, due: &[f64]) {
        self.instructions = instructions;
        self.form = match due.len() {
            0 => Form::default(),
            _ if instructions.level() == Level::Built => Form::default(),
            disks if disks <= Wide::<2>::MOST_DISKS => Form::Two(Wide::new(disks)),
            disks if disks <= Wide::<3>::MOST_DISKS => Form::Three(Wide::new(disks)),
            _ => Form::default(),
        };
        match &mut self.form {
            Form::Fours(fours) => fours.reset(due),
            Form::Two(wide) => wide::reset(instructions, wide, due),
            Form::Three(wide) => wide::reset(instructions, wide, due),
        }
    }
}

impl EventScheduler for TournamentTree {
    fn reset(&mut self, due: &[f64]) {
        self.reset_with(Instructions::detected(), due);
    }

    #[inline(always)]
    fn set(&mut self, disk: usize, due: f64) {
        match &mut self.form {
            Form::Fours(fours) => fours.set(disk, due),
            Form::Two(wide) => wide::set(self.instructions, wide, disk, due),
            Form::Three(wide) => wide::set(self.instructions, wide, disk, due),
        }
    }

    #[inline(always)]
    fn earliest(&self) -> (usize, f64) {
        match &self.form {
            Form::Fours(fours) => fours.earliest(),
            Form::Two(wide) => wide.earliest(),
            Form::Three(wide) => wide.earliest(),
        }
    }
}
