//! What the page calls. Numbers go in as arguments; what comes out lies in buffers whose place the page asks
//! for, so the page never hands over an address.
//!
//! `no_mangle` counts as unsafe since two functions of one name would clash in the linker. These names are
//! those of this module only, and `page/worker.js` calls them. A function that can fail returns 0, or 1 and
//! leaves a text.

#![allow(unsafe_code, reason = "the attribute no_mangle; there is no unsafe block")]

use std::cell::RefCell;

use crate::plan::Setting;
use crate::run::{Advance, Run};
use crate::scene::{Failure, Scene};

#[derive(Default)]
struct Page {
    run: Option<Run>,
    numbers: Vec<f32>,
    text: String,
}

thread_local! { static PAGE: RefCell<Page> = RefCell::default(); }

/// Starts a run anew, with a large disk if its diameter is not 0.
#[unsafe(no_mangle)]
pub extern "C" fn start(
    seed: f64,
    diameter: f64,
    density: f64,
    friction: f64,
    q: f64,
    gravity: f64,
    amplitude: f64,
    frequency: f64,
) -> u32 {
    let setting = setting([friction, q, gravity, amplitude, frequency]);
    attempt(|page| {
        page.run = Some(Run::new(seed as u64, Scene::with_large_disk(diameter, density)?, setting)?);
        Ok(())
    })
}

/// Asks for another setting, and leaves the number of the oscillation from which on it acts as a text.
#[unsafe(no_mangle)]
pub extern "C" fn ask(friction: f64, q: f64, gravity: f64, amplitude: f64, frequency: f64) -> u32 {
    let setting = setting([friction, q, gravity, amplitude, frequency]);
    attempt(|page| {
        page.text = running(&mut page.run)?.ask(setting)?.to_string();
        Ok(())
    })
}

/// Advances to so many oscillations, or by so many collisions, whichever comes first.
#[unsafe(no_mangle)]
pub extern "C" fn advance(to: f64, most_collisions: u32, marks: u32) -> u32 {
    let advance = Advance { to, most_collisions: most_collisions.into(), marks: marks != 0 };
    attempt(|page| running(&mut page.run)?.advance(advance).map(|_| ()))
}

/// Goes to the next collision.
#[unsafe(no_mangle)]
pub extern "C" fn step() -> u32 {
    attempt(|page| running(&mut page.run)?.step())
}

/// Returns the oscillations since the start.
#[unsafe(no_mangle)]
pub extern "C" fn oscillations() -> f64 {
    ask_run(0.0, Run::oscillations)
}

/// Returns the collisions since the start.
#[unsafe(no_mangle)]
pub extern "C" fn collisions() -> f64 {
    ask_run(0.0, |run| run.collisions() as f64)
}

/// Leaves position, angle, angular velocity and radius of each disk.
#[unsafe(no_mangle)]
pub extern "C" fn disks() {
    leave(|run, out| {
        for disk in run.simulation().disks() {
            let (place, radius) = (disk.position(), disk.radius());
            let all = [place.x, place.y, disk.angle(), disk.angular_velocity(), radius];
            out.extend(all.map(|number| number as f32));
        }
    });
}

/// Leaves mean velocity and number of disks of each cell of the flow.
#[unsafe(no_mangle)]
pub extern "C" fn flow() {
    leave(|run, out| {
        out.extend(
            run.watch().flow.cells().flat_map(|(mean, count)| [mean.x as f32, mean.y as f32, count as f32]),
        );
    });
}

/// Leaves the collisions that were marked, and forgets them.
#[unsafe(no_mangle)]
pub extern "C" fn marks() {
    leave(|run, out| out.extend(run.watch().marks.drain(..).flat_map(|mark| mark.0)));
}

/// Leaves the new samples, and forgets them: oscillation, both order parameters or both heights, and noise.
#[unsafe(no_mangle)]
pub extern "C" fn samples() {
    leave(|run, out| {
        for sample in run.watch().fresh.drain(..) {
            let [first, second] = sample.plotted;
            out.extend([sample.oscillation as f64, first, second, sample.noise].map(|number| number as f32));
        }
    });
}

/// Leaves both order parameters or both heights, the height of the center of mass, and that of the base.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() {
    leave(|run, out| {
        let ([first, second], height) = run.plotted();
        out.extend([first, second, height, run.base()].map(|number| number as f32));
    });
}

/// Leaves the paper's lines; see `diagram`.
#[unsafe(no_mangle)]
pub extern "C" fn lines(larger_gravity: u32, largest_inelasticity: f64) -> u32 {
    attempt(|page| {
        page.numbers = crate::diagram::lines(larger_gravity != 0, largest_inelasticity)?;
        Ok(())
    })
}

/// Leaves the hash of the state as a text.
#[unsafe(no_mangle)]
pub extern "C" fn hash() -> u32 {
    attempt(|page| {
        page.text = running(&mut page.run)?.hash();
        Ok(())
    })
}

/// Leaves the name of the state as a text; an empty one while there are few samples.
#[unsafe(no_mangle)]
pub extern "C" fn state() -> u32 {
    attempt(|page| {
        page.text = running(&mut page.run)?.watch().state().unwrap_or_default();
        Ok(())
    })
}

/// Returns where the numbers lie that were left last.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_at() -> *const f32 {
    PAGE.with_borrow(|page| page.numbers.as_ptr())
}

/// Returns how many numbers were left last.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_length() -> usize {
    PAGE.with_borrow(|page| page.numbers.len())
}

/// Returns where the text lies that was left last, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text_at() -> *const u8 {
    PAGE.with_borrow(|page| page.text.as_ptr())
}

/// Returns how many bytes the text has that was left last.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    PAGE.with_borrow(|page| page.text.len())
}

fn setting(numbers: [f64; 5]) -> Setting {
    let [friction, inelasticity, gravity, amplitude, angular_frequency] = numbers;
    Setting { friction, inelasticity, gravity, amplitude, angular_frequency }
}

fn running(run: &mut Option<Run>) -> Result<&mut Run, Failure> {
    run.as_mut().ok_or_else(|| "no run was started".into())
}

/// Tries, and leaves the error and what caused it as a text.
fn attempt(work: impl FnOnce(&mut Page) -> Result<(), Failure>) -> u32 {
    PAGE.with_borrow_mut(|page| match work(page) {
        Ok(()) => 0,
        Err(error) => {
            let causes = std::iter::successors(error.source(), |error| error.source());
            page.text = causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"));
            1
        }
    })
}

fn ask_run<T>(otherwise: T, question: impl FnOnce(&Run) -> T) -> T {
    PAGE.with_borrow(|page| page.run.as_ref().map_or(otherwise, question))
}

fn leave(write: impl FnOnce(&mut Run, &mut Vec<f32>)) {
    PAGE.with_borrow_mut(|Page { run, numbers, .. }| {
        numbers.clear();
        if let Some(run) = run {
            write(run, numbers);
        }
    });
}
