//! Checks of a driving's contract, for custom drivings.

use glam::{DVec2, DVec3};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Driving;
use crate::random::uniform;
use crate::violation::require;
use crate::{Disk, Kind, ParameterError, Violation};

const PART: &str = "driving";

/// Number of kicks of a check, and number of disks.
const KICKS: usize = 1600;
const DISKS: usize = 16;

/// Number of kicks after which the check interrupts a run, and after which it restores the initial disks, so
/// that the disks become neither too fast nor too slow.
const CUT: usize = 7;
const AGAIN: usize = 200;

/// Allowed rounding of a momentum, relative to the sum of all magnitudes.
const ROUNDING: f64 = 1e-13;

/// Smallest and largest mean square of the kicks at a position in the list, relative to the mean of all
/// positions. If each kick changes one disk at random, the mean squares scatter by a tenth.
const FAIR: [f64; 2] = [0.5, 1.6];

/// Largest deviation of such a mean square from the mean of all positions, in standard errors. The disks come
/// to the positions at random, so the errors are independent.
const ERRORS: f64 = 7.0;

/// Largest correlation of two kicks in a row at a position in the list, beyond the correlation between any
/// two different positions. Random kicks have a correlation of a hundredth.
const CORRELATED: f64 = 0.2;

/// The parts of a kick that are compared on their own: velocities and spins. In their sum, a fault in the
/// weaker part would be lost.
const PARTS: [DVec3; 2] = [DVec3::new(1.0, 1.0, 0.0), DVec3::Z];

/// Largest change of a velocity that counts as rounding, and smallest one that counts as another kick.
const SAME: f64 = 1e-9;
const OTHER: f64 = 1e-6;

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

/// Checks that drivings keep their contract and these promises, in 1600 kicks of sixteen disks.
///
/// The closure `make` returns a fresh driving each time. Two drivings kick the same disks: one in a run, and
/// one in a run that is cut into two. The order of the disks changes from kick to kick.
///
/// Three more drivings show whether disks are remembered by their position in the list. If the kicks are the
/// same in two opposite orders that never change, they must also be the same in an order that changes.
/// Otherwise, random numbers may be drawn in the order of the list, and the check only requires that a kick
/// does not resemble the previous one at its position. The page "Validation" says which planted faults the
/// check finds.
///
/// # Errors
/// Returns the first broken promise.
pub fn check<D: Driving>(make: impl FnMut() -> D, promises: &Promises) -> Result<(), Violation> {
    let mut make = make;
    let disks = disks().map_err(|error| failed(&error))?;
    let (mut whole, mut cut) = (make(), make());
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let mut sums = PARTS.map(Sums::of);
    whole.kick(&mut []).and_then(|()| cut.kick(&mut [])).map_err(|error| failed(&error))?;
    let (mut last, mut random) = (0.0, Xoshiro256PlusPlus::seed_from_u64(1));
    for driving in [&mut whole, &mut cut] {
        driving.times().start_at(last);
    }
    for number in 0..KICKS {
        if number == CUT {
            cut.times().start_at(last);
        }
        if number % AGAIN == 0 {
            (first, second) = (disks.clone(), disks.clone());
        }
        let again = number % 4;
        let (time, other) = (upcoming(&mut whole, last, again)?, upcoming(&mut cut, last, again)?);
        require!(PART, "clock", time == other;
            "kick {number} is at {time:?}, and at {other:?} if the run is cut");
        let before = first.clone();
        whole.kick(&mut first).and_then(|()| cut.kick(&mut second)).map_err(|error| failed(&error))?;
        check_kick(&before, &first, *promises, number)?;
        require!(PART, "repeatable", first == second; "kick {number} of two equal drivings differs");
        for sums in &mut sums {
            sums.add(&before, &first);
        }
        for driving in [&mut whole, &mut cut] {
            driving.times().advance_past(time);
        }
        last = time;
        // Each disk comes to each position in the list, whatever the period of the driving.
        let turn = (uniform(&mut random) * DISKS as f64) as usize;
        first.rotate_left(turn);
        second.rotate_left(turn);
    }
    if promises.is_ordered {
        return Ok(());
    }
    sums.iter().try_for_each(Sums::check)?;
    check_memory(make, &disks)
}

/// Returns this part of the kicks of all disks, times the roots of their masses, divided by the root of the
/// sum of their squares. The last component is the spin. Returns `None` for a kick that is zero up to
/// rounding, since it shows nothing.
fn shares_of(before: &[Disk], after: &[Disk], part: DVec3) -> Option<[DVec3; DISKS]> {
    let kicks: [DVec3; DISKS] = std::array::from_fn(|place| {
        let (old, new) = (&before[place], &after[place]);
        let turned = old.radius() * (new.angular_velocity() - old.angular_velocity());
        old.mass().sqrt() * part * (new.velocity() - old.velocity()).extend(turned)
    });
    let energy: f64 = before.iter().map(|disk| disk.mass() * disk.velocity().length_squared()).sum();
    let all: f64 = kicks.iter().map(|kick| kick.length_squared()).sum();
    (all > ROUNDING * energy).then(|| kicks.map(|kick| kick / all.sqrt()))
}

/// Sums over one part of the kicks, by their position in the list.
#[derive(Default)]
struct Sums {
    part: DVec3,
    latest: Option<[DVec3; DISKS]>,
    /// Number of kicks that are not zero.
    counted: usize,
    squares: [f64; DISKS],
    /// Sums of the squares of the squares.
    fourths: [f64; DISKS],
    /// Sums of the products of two kicks in a row, by the distance between their positions.
    products: [f64; DISKS],
}

impl Sums {
    fn of(part: DVec3) -> Self {
        Self { part, ..Self::default() }
    }

    fn add(&mut self, before: &[Disk], after: &[Disk]) {
        let kicks = shares_of(before, after, self.part);
        let latest = std::mem::replace(&mut self.latest, kicks);
        let Some(kicks) = kicks else { return };
        self.counted += 1;
        for (place, kick) in kicks.iter().enumerate() {
            let square = kick.length_squared();
            self.squares[place] += square;
            self.fourths[place] += square * square;
        }
        let Some(latest) = latest else { return };
        for (distance, product) in self.products.iter_mut().enumerate() {
            let shifted = kicks.iter().cycle().skip(distance);
            *product += latest.iter().zip(shifted).map(|(old, new)| old.dot(*new)).sum::<f64>();
        }
    }

    /// Checks that no position in the list receives stronger or weaker kicks than others, beyond chance, or
    /// kicks that resemble the previous ones at this position.
    fn check(&self) -> Result<(), Violation> {
        if self.counted < KICKS / 2 {
            return Ok(());
        }
        let [disks, kicks] = [DISKS, self.counted].map(|count| count as f64);
        for (place, square) in self.squares.iter().enumerate() {
            let (mean, fourth) = (square / kicks, self.fourths[place] / kicks);
            let error = (f64::max(fourth - mean * mean, 0.0) / kicks).sqrt();
            let (share, is_chance) = (mean * disks, (mean - 1.0 / disks).abs() <= ERRORS * error + ROUNDING);
            require!(PART, "alike", is_chance && (FAIR[0]..=FAIR[1]).contains(&share);
                "disks at place {place} of the list get {share:?} of the mean square kick");
        }
        let [here, elsewhere @ ..] = self.products.map(|product| product / KICKS as f64);
        let usual = elsewhere.into_iter().fold(f64::NEG_INFINITY, f64::max);
        require!(PART, "memory", here - usual <= CORRELATED;
            "two kicks in a row at a place of the list, where the disks change, have a correlation of {here:?}; \
             at two other places, it is {usual:?} at most");
        Ok(())
    }
}

/// Checks that kicks that do not depend on the order of the disks do not depend on changes of the order
/// either.
fn check_memory<D: Driving>(mut make: impl FnMut() -> D, disks: &[Disk]) -> Result<(), Violation> {
    let kept = kicked(make(), disks, false, |_| 0)?;
    // No two disks keep their order in the reversed list, even if the driving selects only a few of them.
    let reversed = kicked(make(), disks, true, |_| 5)?;
    let changing = kicked(make(), disks, false, |number| number * (number + 1) / 2)?;
    let differ = |other: &[Disk], least: f64| {
        kept.iter().zip(other).position(|(one, other)| {
            let turn = one.radius() * (one.angular_velocity() - other.angular_velocity());
            let scale = 1.0 + one.velocity().length() + other.velocity().length();
            (one.velocity() - other.velocity()).extend(turn).length() > least * scale
        })
    };
    if differ(&reversed, SAME).is_some() {
        return Ok(());
    }
    let Some(index) = differ(&changing, OTHER) else { return Ok(()) };
    let (number, id) = (index / DISKS, kept[index].id());
    let [one, other] =
        [&kept[index], &changing[index]].map(|disk| (disk.velocity(), disk.angular_velocity()));
    let sentence = format!(
        "after kick {number}, disk {id} has the velocity and spin {one:?}, and {other:?} if the order changes"
    );
    Err(Violation::new(PART, "memory", sentence))
}

/// Returns the disks after each kick. For kick `n`, the list is rotated so that it starts with disk
/// `order(n)`, and then reversed if `is_reversed`.
fn kicked<D: Driving>(
    mut driving: D,
    disks: &[Disk],
    is_reversed: bool,
    order: fn(usize) -> usize,
) -> Result<Vec<Disk>, Violation> {
    let (mut disks, mut all, mut last) = (disks.to_vec(), Vec::new(), 0.0);
    driving.times().start_at(last);
    for number in 0..AGAIN {
        let first = order(number) % DISKS;
        disks.rotate_left(first);
        if is_reversed {
            disks.reverse();
        }
        driving.kick(&mut disks).map_err(|error| failed(&error))?;
        if is_reversed {
            disks.reverse();
        }
        disks.rotate_right(first);
        last = upcoming(&mut driving, last, 0)?;
        driving.times().advance_past(last);
        all.extend_from_slice(&disks);
    }
    Ok(all)
}

fn failed(error: &ParameterError) -> Violation {
    Violation::new(PART, "no failure", error.to_string())
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
