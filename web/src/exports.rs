//! The functions that JavaScript calls.
//!
//! Only numbers cross the border. What is more than a number lies in a buffer of this side: a function
//! returns its address, and `length` its length. A buffer holds until the next call that fills it. Functions
//! that can fail return 1 then, and leave the reason in the buffer of `error`.
//!
//! `no_mangle` is the one attribute here that Rust calls unsafe, since two functions of one name would clash.
//! The names are those of this file alone. No memory is touched through an address of JavaScript's.

use std::cell::RefCell;

use granular_edmd::kinetic::{IsoLine, Maxwellian};
use granular_edmd::prelude::*;

use crate::rolls::{Failure, Rolls};
use crate::settings::Settings;

/// The simulation, and the buffers that JavaScript reads.
#[derive(Default)]
struct Page {
    rolls: Option<Rolls>,
    numbers: Vec<f64>,
    singles: Vec<f32>,
    text: String,
    length: usize,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

impl Page {
    fn ask<T>(&mut self, of: impl FnOnce(&mut Rolls) -> T, otherwise: T) -> T {
        self.rolls.as_mut().map_or(otherwise, of)
    }

    fn attempt(&mut self, deed: impl FnOnce(&mut Self) -> Result<(), Failure>) -> i32 {
        let failure = deed(self).err();
        self.text = failure.as_ref().map_or_else(String::new, ToString::to_string);
        i32::from(failure.is_some())
    }

    fn with_rolls(&mut self, deed: impl FnOnce(&mut Rolls) -> Result<(), Failure>) -> i32 {
        self.attempt(|page| page.rolls.as_mut().ok_or("there is no box yet".into()).and_then(deed))
    }

    fn lend_singles(&mut self, singles: Vec<f32>) -> *const f32 {
        (self.length, self.singles) = (singles.len(), singles);
        self.singles.as_ptr()
    }

    fn lend_numbers(&mut self, numbers: Vec<f64>) -> *const f64 {
        (self.length, self.numbers) = (numbers.len(), numbers);
        self.numbers.as_ptr()
    }
}

fn with<T>(of: impl FnOnce(&mut Page) -> T) -> T {
    PAGE.with_borrow_mut(of)
}

const fn settings(
    friction: f64,
    inelasticity: f64,
    gravity: f64,
    amplitude: f64,
    angular_frequency: f64,
) -> Settings {
    Settings { friction, inelasticity, gravity, amplitude, angular_frequency }
}

#[unsafe(no_mangle)]
extern "C" fn create(
    seed: u32,
    friction: f64,
    inelasticity: f64,
    gravity: f64,
    amplitude: f64,
    frequency: f64,
) -> i32 {
    let settings = settings(friction, inelasticity, gravity, amplitude, frequency);
    with(|page| {
        page.attempt(|page| {
            page.rolls = Some(Rolls::new(settings, seed.into())?);
            Ok(())
        })
    })
}

#[unsafe(no_mangle)]
extern "C" fn set(friction: f64, inelasticity: f64, gravity: f64, amplitude: f64, frequency: f64) -> i32 {
    let settings = settings(friction, inelasticity, gravity, amplitude, frequency);
    with(|page| page.with_rolls(|rolls| rolls.set(settings)))
}

#[unsafe(no_mangle)]
extern "C" fn advance(oscillations: f64, with_marks: i32) -> i32 {
    with(|page| page.with_rolls(|rolls| rolls.advance(oscillations, with_marks != 0)))
}

#[unsafe(no_mangle)]
extern "C" fn step() -> i32 {
    with(|page| page.with_rolls(Rolls::step))
}

/// Lends place, spin of each disk: three numbers each.
#[unsafe(no_mangle)]
extern "C" fn disks() -> *const f32 {
    with(|page| {
        let disks = page.ask(|rolls| rolls.disks(), Vec::new());
        let numbers = |disk: &Disk| {
            [disk.position().x as f32, disk.position().y as f32, disk.angular_velocity() as f32]
        };
        page.lend_singles(disks.iter().flat_map(numbers).collect())
    })
}

/// Lends count and momentum of each cell of the flow.
#[unsafe(no_mangle)]
extern "C" fn flow() -> *const f32 {
    with(|page| {
        let cells = page.ask(|rolls| rolls.flow().cells().to_vec(), Vec::new());
        page.lend_singles(cells)
    })
}

/// Lends oscillation and order parameters of the new samples.
#[unsafe(no_mangle)]
extern "C" fn history() -> *const f64 {
    with(|page| {
        let history = page.ask(Rolls::take_history, Vec::new());
        page.lend_numbers(history)
    })
}

/// Lends the places of the new collisions.
#[unsafe(no_mangle)]
extern "C" fn marks() -> *const f32 {
    with(|page| {
        let marks = page.ask(Rolls::take_marks, Vec::new());
        page.lend_singles(marks)
    })
}

/// Lends the line of a mean energy change: pairs of friction and inelasticity, with NaN between its pieces.
#[unsafe(no_mangle)]
extern "C" fn iso_line(energy_change: f64) -> *const f64 {
    with(|page| page.lend_numbers(line(energy_change).unwrap_or_default()))
}

fn line(energy_change: f64) -> Result<Vec<f64>, ParameterError> {
    // Frictions from 0.005 to 3, in equal steps of the logarithm.
    let frictions: Vec<f64> =
        (0..=400).map(|step| 0.005 * (600_f64.ln() * f64::from(step) / 400.0).exp()).collect();
    let pieces = IsoLine::new(energy_change, &Maxwellian::new(1.0)?)?.trace(&frictions, 0.3)?;
    let piece =
        |piece: Vec<(f64, f64)>| piece.into_iter().chain([(f64::NAN, f64::NAN)]).flat_map(|(x, y)| [x, y]);
    Ok(pieces.into_iter().flat_map(piece).collect())
}

/// Lends the reason of the last failure, in UTF-8.
#[unsafe(no_mangle)]
extern "C" fn error() -> *const u8 {
    with(|page| {
        page.length = page.text.len();
        page.text.as_ptr()
    })
}

/// Returns the length of the buffer that was lent last.
#[unsafe(no_mangle)]
extern "C" fn length() -> usize {
    with(|page| page.length)
}

#[unsafe(no_mangle)]
extern "C" fn oscillation() -> f64 {
    with(|page| page.ask(|rolls| rolls.oscillation(), 0.0))
}

#[unsafe(no_mangle)]
extern "C" fn collisions() -> f64 {
    with(|page| page.ask(|rolls| rolls.collisions() as f64, 0.0))
}

#[unsafe(no_mangle)]
extern "C" fn base_displacement() -> f64 {
    with(|page| page.ask(|rolls| rolls.base_displacement(), 0.0))
}

#[unsafe(no_mangle)]
extern "C" fn is_waiting() -> i32 {
    with(|page| i32::from(page.ask(|rolls| rolls.is_waiting(), false)))
}

#[unsafe(no_mangle)]
extern "C" fn hash() -> u64 {
    with(|page| page.ask(|rolls| rolls.hash(), 0))
}
