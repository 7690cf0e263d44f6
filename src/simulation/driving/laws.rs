//! Checks of a driving's contract, for custom drivings.

use glam::DVec2;

use super::Driving;
use crate::violation::require;
use crate::{Disk, Kind, ParameterError, Violation};

const PART: &str = "driving";

/// Number of kicks of a check, and number of disks.
const KICKS: usize = 200;
const DISKS: usize = 16;

/// Number of kicks after which the check interrupts a run.
const CUT: usize = 7;

/// Allowed rounding of a momentum, relative to the sum of all magnitudes.
const ROUNDING: f64 = 1e-13;

/// Smallest and largest mean square of the kicks at a position in the list, relative to the mean of all
/// positions. Two hundred random kicks scatter by a tenth.
const FAIR: [f64; 2] = [0.4, 1.8];

/// The promises of a driving. Every driving also promises kicks that only change velocities and spins, that
/// are alike for all disks in the list, and that repeat to the bit.
///
/// ```
/// use granular_edmd::observable::SampleTimes;
/// use granular_edmd::simulation::laws::{Promises, check};
/// use granular_edmd::simulation::{Rescaling, WhiteNoise};
///
/// let clock = SampleTimes::every(0.5)?;
/// let noise = WhiteNoise::new(0.1, clock, 42)?;
/// check(|| noise.clone(), &Promises::new().with_momentum())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Promises {
    momentum: bool,
    moves: bool,
    is_ordered: bool,
}

impl Promises {
    /// Creates the promises of every driving.
    pub const fn new() -> Self {
        Self { momentum: false, moves: false, is_ordered: false }
    }

    /// Returns the same promises, with a conserved total momentum.
    pub const fn with_momentum(self) -> Self {
        Self { momentum: true, ..self }
    }

    /// Returns the same promises for a driving that also changes positions and angles.
    pub const fn with_moves(self) -> Self {
        Self { moves: true, ..self }
    }

    /// Returns the same promises for a driving whose kicks depend on the position of a disk in the list.
    pub const fn with_order(self) -> Self {
        Self { is_ordered: true, ..self }
    }
}

/// Checks that drivings keep their contract and these promises, in two hundred kicks of sixteen disks.
///
/// The closure `make` returns a fresh driving each time. Two drivings kick the same disks: one in a run, and
/// one in a run that is cut into two. The page "Validation" says which planted faults the check finds.
///
/// # Errors
/// The first promise that is broken.
pub fn check<D: Driving>(make: impl FnMut() -> D, promises: &Promises) -> Result<(), Violation> {
    let mut make = make;
    let failed = |error: ParameterError| Violation::new(PART, "no failure", error.to_string());
    let disks = disks().map_err(failed)?;
    let (mut whole, mut cut) = (make(), make());
    let (mut first, mut second) = (disks.clone(), disks);
    let (mut squares, mut counted) = ([0.0; DISKS], 0);
    whole.kick(&mut []).and_then(|()| cut.kick(&mut [])).map_err(failed)?;
    let mut last = 0.0;
    for driving in [&mut whole, &mut cut] {
        driving.times().start_at(last);
    }
    for number in 0..KICKS {
        if number == CUT {
            cut.times().start_at(last);
        }
        let again = number % 4;
        let (time, other) = (upcoming(&mut whole, last, again)?, upcoming(&mut cut, last, again)?);
        require!(PART, "clock", time == other;
            "kick {number} is at {time:?}, and at {other:?} if the run is cut");
        let before = first.clone();
        whole.kick(&mut first).and_then(|()| cut.kick(&mut second)).map_err(failed)?;
        check_kick(&before, &first, *promises, number)?;
        require!(PART, "repeatable", first == second; "kick {number} of two equal drivings differs");
        let kicks = squares_of(&before, &first);
        let energy: f64 = before.iter().map(|disk| disk.mass() * disk.velocity().length_squared()).sum();
        let all: f64 = kicks.iter().sum();
        // A kick that is zero up to rounding shows nothing about shares.
        if all > ROUNDING * energy {
            counted += 1;
            squares.iter_mut().zip(&kicks).for_each(|(square, kick)| *square += kick / all);
        }
        for driving in [&mut whole, &mut cut] {
            driving.times().advance_past(time);
        }
        last = time;
        // Each disk comes to each position in the list.
        first.rotate_left(1);
        second.rotate_left(1);
    }
    if counted < KICKS / 2 || promises.is_ordered { Ok(()) } else { check_shares(&squares) }
}

/// Returns the squares of the kicks of all disks, times their masses.
fn squares_of(before: &[Disk], after: &[Disk]) -> [f64; DISKS] {
    std::array::from_fn(|place| {
        let (old, new) = (&before[place], &after[place]);
        let turned = old.radius() * (new.angular_velocity() - old.angular_velocity());
        old.mass() * ((new.velocity() - old.velocity()).length_squared() + turned * turned)
    })
}

/// Returns the time of the next kick. Checks that this time is later than the last kick, and the same in a
/// second call.
fn upcoming<D: Driving>(driving: &mut D, last: f64, again: usize) -> Result<f64, Violation> {
    let next = driving.times().upcoming();
    require!(PART, "clock", next > last; "after the time {last:?}, the next kick is at {next:?}");
    for _ in 0..again {
        let again = driving.times().upcoming();
        require!(PART, "clock", next == again;
            "the next kick is at {next:?}, and at {again:?} when asked again");
    }
    Ok(next)
}

/// Checks a kick by the disks before and after it.
fn check_kick(before: &[Disk], after: &[Disk], promises: Promises, number: usize) -> Result<(), Violation> {
    for (old, new) in before.iter().zip(after) {
        let (mut place, mut angle, mut image) = (old.position(), old.angle(), old.image());
        if promises.moves {
            (place, angle, image) = (new.position(), new.angle(), new.image());
        }
        let allowed = old.with_motion(place, new.velocity(), angle, new.angular_velocity()).with_image(image);
        require!(PART, "velocities only", allowed == *new; "kick {number} makes {new:?} of {old:?}");
    }
    if promises.momentum {
        let momentum = |disks: &[Disk]| disks.iter().map(|disk| disk.mass() * disk.velocity()).sum::<DVec2>();
        let gained = (momentum(after) - momentum(before)).length();
        let size: f64 = before.iter().chain(after).map(|disk| disk.mass() * disk.velocity().length()).sum();
        require!(PART, "momentum", gained <= ROUNDING * size; "kick {number} adds the momentum {gained:?}");
    }
    Ok(())
}

/// Checks that no position in the list receives much stronger or weaker kicks than others.
fn check_shares(squares: &[f64; DISKS]) -> Result<(), Violation> {
    let mean = squares.iter().sum::<f64>() / DISKS as f64;
    for (place, square) in squares.iter().enumerate() {
        let share = square / mean;
        let is_fair = (FAIR[0]..=FAIR[1]).contains(&share);
        require!(PART, "alike", is_fair;
            "disks at place {place} of the list get {share:?} of the mean square kick");
    }
    Ok(())
}

/// Returns disks of several masses, radii and kinds, with ids, angles and images.
fn disks() -> Result<Vec<Disk>, ParameterError> {
    (0..DISKS as u16)
        .map(|number| {
            let turn = f64::from(number);
            Disk::new(DVec2::new(1.0 + turn, 2.0 + 0.1 * turn), 0.25 + 0.02 * turn)?
                .with_mass(1.0 + 0.1 * turn)?
                .with_velocity(DVec2::new(libm::sin(turn), libm::cos(3.0 * turn)))?
                .with_angular_velocity(libm::sin(2.0 * turn))?
                .with_angle(turn)?
                .with_kind(Kind::new(number % 3))
                .with_image([i32::from(number) - 5, 2])
                .with_id(u64::from(number) + 10)
        })
        .collect()
}
