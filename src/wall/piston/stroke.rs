//! The motion of a piston from one impact to the next, in closed form.

use super::Piston;
use crate::quantity::accept;
use crate::roots::first_descent;
use crate::wall::{AccelerationBounds, WallMotion, WallState};
use crate::{Fingerprint, ParameterError};

/// Largest number of pieces. A piston that comes to a stop leaves it from rest or not at all. On a spring, it
/// can then come to the other stop, but only once: from there, it swings less far and does not reach the
/// first stop.
const MOST_PIECES: usize = 4;

/// Number of parts into which a spring's period is divided; each part has its own bounds on the acceleration.
const PARTS: f64 = 16.0;

/// Largest speed at a stop that counts as zero, relative to the speed of the motion.
const GRAZE: f64 = 1e-7;

/// Rounding error of a time origin, relative to the origin.
const ROUNDING: f64 = 1e-12;

/// The motion of a piston since the last impact. Phases are offsets from the time origin, since a piston has
/// no period that would keep the digits of late times.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Piston", into = "Piston"))]
pub(crate) struct Stroke {
    piston: Piston,
    /// The absolute time from which phases count, once it is known.
    origin: Option<f64>,
    /// The pieces in the order of their times. The first piece begins at the last impact.
    pieces: Vec<Piece>,
}

/// A motion without an impact and without a stop.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    displacement: f64,
    velocity: f64,
    /// True if the piston rests at a stop.
    is_held: bool,
    /// Phase at which the piston comes to a stop.
    until: f64,
}

impl From<Piston> for Stroke {
    fn from(piston: Piston) -> Self {
        Self::new(piston, None, 0.0, piston.displacement, piston.velocity)
    }
}

impl From<Stroke> for Piston {
    fn from(stroke: Stroke) -> Self {
        stroke.piston
    }
}

impl Stroke {
    fn new(piston: Piston, origin: Option<f64>, start: f64, displacement: f64, velocity: f64) -> Self {
        let mut pieces = vec![piece(&piston, start, displacement, velocity)];
        while let Some(last) = pieces.last().filter(|last| last.until < f64::INFINITY).copied()
            && pieces.len() < MOST_PIECES
        {
            let is_high =
                last.state(&piston, last.until).displacement > 0.5 * (piston.lowest + piston.highest);
            let stop = if is_high { piston.highest } else { piston.lowest };
            // A stop absorbs all of the speed. The next piece begins at the stop itself, not where rounding
            // ended this one.
            pieces.push(piece(&piston, last.until, stop, 0.0));
        }
        Self { piston, origin, pieces }
    }

    pub(crate) const fn mass(&self) -> f64 {
        self.piston.mass
    }

    /// Returns the displacement at the start of a run.
    pub(crate) const fn first_displacement(&self) -> f64 {
        self.piston.displacement
    }

    /// Returns the motion after an impulse along the normal at this phase.
    pub(crate) fn struck(&self, impulse: f64, phase: f64) -> Self {
        let WallState { displacement, velocity } = self.state(phase);
        Self::new(self.piston, self.origin, phase, displacement, velocity + impulse / self.piston.mass)
    }

    /// Returns the same motion with phases that count from this absolute time.
    ///
    /// An origin before the last impact belongs to another run, which the piston begins in its initial state.
    pub(crate) fn at_origin(&self, origin: f64) -> Self {
        let Some(before) = self.origin else { return Self { origin: Some(origin), ..self.clone() } };
        let (by, rounding) = (origin - before, ROUNDING * (origin.abs() + before.abs()));
        if by < self.pieces[0].start - rounding {
            Self { origin: Some(origin), ..Self::from(self.piston) }
        } else if by > 0.0 {
            let WallState { displacement, velocity } = self.state(by);
            Self::new(self.piston, Some(origin), 0.0, displacement, velocity)
        } else {
            Self { origin: Some(origin), ..self.clone() }
        }
    }

    /// Returns the phase of the last impact, with the displacement and velocity after it.
    pub(crate) fn numbers(&self) -> [f64; 3] {
        let first = &self.pieces[0];
        [first.start, first.displacement, first.velocity]
    }

    /// Returns the motion with other [`numbers`](Self::numbers).
    ///
    /// # Errors
    /// If the displacement is not between the stops, or a number is not finite.
    pub(crate) fn with_numbers(
        &self,
        [start, displacement, velocity]: [f64; 3],
    ) -> Result<Self, ParameterError> {
        let piston = self.piston.with_start(displacement, velocity)?;
        accept(start.is_finite(), "phase of the last blow", "finite", start)?;
        let (displacement, velocity) = (piston.displacement, piston.velocity);
        Ok(Self::new(self.piston, self.origin, start, displacement, velocity))
    }

    /// Returns displacements between which the piston stays from the last impact to this phase.
    pub(crate) fn range_until(&self, until: f64) -> (f64, f64) {
        let Piece { start, displacement, velocity, .. } = self.pieces[0];
        let elapsed = (until - start).max(0.0);
        // The pull is largest at the lower stop, and smallest at the upper one, if it changes at all.
        let [up, down] =
            [self.piston.lowest, self.piston.highest].map(|stop| self.piston.acceleration_at(stop));
        let way = |speed: f64, pull: f64| (speed + 0.5 * pull * elapsed) * elapsed;
        let low = displacement + way(velocity.min(0.0), down.min(0.0));
        let high = displacement + way(velocity.max(0.0), up.max(0.0));
        (low.max(self.piston.lowest), high.min(self.piston.highest))
    }

    /// Returns the energy of the piston at a phase.
    pub(crate) fn energy(&self, phase: f64) -> f64 {
        let WallState { displacement, velocity } = self.state(phase);
        self.piston.energy(displacement, velocity)
    }

    fn piece_at(&self, phase: f64) -> &Piece {
        let later = self.pieces.iter().skip(1).take_while(|piece| piece.start <= phase);
        later.last().unwrap_or(&self.pieces[0])
    }
}

impl WallMotion for Stroke {
    fn state(&self, phase: f64) -> WallState {
        let WallState { displacement, velocity } = self.piece_at(phase).state(&self.piston, phase);
        // Rounding may carry the piston a little beyond its stops.
        WallState::new(displacement.clamp(self.piston.lowest, self.piston.highest), velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let piece = self.piece_at(phase);
        if piece.is_held {
            return AccelerationBounds::new(piece.until, 0.0, 0.0);
        }
        let square = self.piston.square_of_frequency();
        let now = self.piston.acceleration_at(piece.state(&self.piston, phase).displacement);
        if square == 0.0 {
            return AccelerationBounds::new(piece.until, now, now);
        }
        let frequency = square.sqrt();
        let jerk = square * frequency * piece.swing(&self.piston).amplitude;
        let length = std::f64::consts::TAU / (PARTS * frequency);
        let bounds = AccelerationBounds::from_jerk(phase, now, jerk, length);
        AccelerationBounds::new(bounds.until.min(piece.until), bounds.min, bounds.max)
    }

    fn reach(&self) -> (f64, f64) {
        (self.piston.lowest, self.piston.highest)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(self.piston.fingerprint())
    }
}

/// The oscillation of a piston on a spring: `a cos θ + b sin θ` about the middle.
#[derive(Clone, Copy)]
struct Swing {
    middle: f64,
    a: f64,
    b: f64,
    amplitude: f64,
}

impl Swing {
    /// Returns the angle, in one turn, at which the oscillation rises through a height above the middle, or
    /// `None` if it does not reach the height.
    ///
    /// The angle of the turning point is $`\varphi`$, with $`\tan\varphi = b/a`$. The crossing is before it
    /// by $`\arccos(h/C)`$. Written as an arc tangent, the difference is exact for a piston that has just
    /// left the stop: an arc cosine near 1 would lose half of the digits, and the piston would come to the
    /// stop immediately.
    ///
    /// An oscillation that turns around at the height, up to rounding, does not rise through it. An
    /// oscillation that starts at the height and rises does rise through it.
    fn rises_through(&self, height: f64) -> Option<f64> {
        let square = (self.a - height) * (self.a + height) + self.b * self.b;
        let may_turn = height > 0.0 && (self.a < height || self.b <= 0.0);
        let least = if may_turn { GRAZE * height } else { 0.0 };
        if square.is_nan() || square <= least * least {
            return None;
        }
        let angle = libm::atan2(self.b, self.a) - libm::atan2(square.sqrt(), height);
        Some(angle.rem_euclid(std::f64::consts::TAU))
    }

    fn mirrored(self) -> Self {
        Self { a: -self.a, b: -self.b, ..self }
    }
}

impl Piece {
    fn swing(&self, piston: &Piston) -> Swing {
        let square = piston.square_of_frequency();
        let middle = piston.center + piston.force / piston.stiffness;
        let (a, b) = (self.displacement - middle, self.velocity / square.sqrt());
        Swing { middle, a, b, amplitude: libm::hypot(a, b) }
    }

    fn state(&self, piston: &Piston, phase: f64) -> WallState {
        let elapsed = phase - self.start;
        if self.is_held {
            return WallState::new(self.displacement, 0.0);
        }
        if piston.stiffness == 0.0 {
            let pull = piston.force / piston.mass;
            let displacement = self.displacement + (self.velocity + 0.5 * pull * elapsed) * elapsed;
            return WallState::new(displacement, self.velocity + pull * elapsed);
        }
        let (Swing { middle, a, b, .. }, frequency) =
            (self.swing(piston), piston.square_of_frequency().sqrt());
        let (sine, cosine) = (libm::sin(frequency * elapsed), libm::cos(frequency * elapsed));
        WallState::new(middle + a * cosine + b * sine, frequency * (b * cosine - a * sine))
    }
}

/// Returns the piece that begins with this state, up to the next stop.
fn piece(piston: &Piston, start: f64, displacement: f64, velocity: f64) -> Piece {
    let pull = piston.acceleration_at(displacement);
    let presses_up = displacement >= piston.highest && velocity >= 0.0 && pull >= 0.0;
    let presses_down = displacement <= piston.lowest && velocity <= 0.0 && pull <= 0.0;
    // A piston that nothing moves between the stops stays at its position, but it is not held: an impact
    // moves it.
    let is_held = presses_up || presses_down;
    let mut piece = Piece { start, displacement, velocity, is_held, until: f64::INFINITY };
    if is_held {
        piece.velocity = 0.0;
    } else {
        piece.until = start + wait(piston, &piece);
    }
    piece
}

/// Returns the time until a piece that is not held comes to a stop.
///
/// A piston that turns at a stop, up to rounding, does not reach the stop. Otherwise, rounding would decide
/// whether it does, and the square root of the rounding error would enter the time of the arrival and all
/// later times.
fn wait(piston: &Piston, piece: &Piece) -> f64 {
    let Piece { displacement, velocity, .. } = *piece;
    let (above, below) = (piston.highest - displacement, displacement - piston.lowest);
    let never = f64::INFINITY;
    if piston.stiffness == 0.0 {
        let pull = piston.force / piston.mass;
        let arrives = |wait: &f64| (velocity + pull * wait).abs() > GRAZE * velocity.abs();
        let up = first_descent(above, -velocity, -pull).filter(arrives).unwrap_or(never);
        return up.min(first_descent(below, velocity, pull).filter(arrives).unwrap_or(never));
    }
    let (swing, frequency) = (piece.swing(piston), piston.square_of_frequency().sqrt());
    let up = swing.rises_through(piston.highest - swing.middle);
    let down = swing.mirrored().rises_through(swing.middle - piston.lowest);
    up.unwrap_or(never).min(down.unwrap_or(never)) / frequency
}
