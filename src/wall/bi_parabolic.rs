//! The paper's vibrating base.

use super::oscillation::{Oscillation, is_even, periodic, periodic_answers, piece};
use super::{AccelerationBounds, WallMotion, WallState};

/// Piecewise constant acceleration that mimics a sine, with two parabolic arcs per period (paper, Sec. III).
///
/// With the half period $`H=\pi/\omega`$ and $`s = t/H`$,
///
/// ```math
/// z(t) = 4A\,s(1-s)\quad (0\le s<1),\qquad z(t+H) = -z(t),
/// ```
///
/// so it has the amplitude and the period of $`A\sin\omega t`$. The peak speed is $`4A/H = 4A\omega/\pi`$ and
/// the acceleration is $`\mp 8A/H^2`$. The time of every contact is the root of a parabola, which is exact
/// and needs no iteration.
///
/// ```
/// use granular_edmd::wall::{BiParabolic, WallMotion};
/// let base = BiParabolic::new(0.1, 10.0)?;
/// let quarter = 0.25 * base.period().unwrap();
/// assert!((base.state(quarter).displacement - 0.1).abs() < 1e-15);
/// assert!((base.state(0.0).velocity - 4.0 * 0.1 * 10.0 / std::f64::consts::PI).abs() < 1e-14);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct BiParabolic {
    oscillation: Oscillation,
}

periodic!(BiParabolic);

impl BiParabolic {
    fn arc(&self, phase: f64) -> Arc {
        let length = 0.5 * self.oscillation.period();
        let (number, end) = piece(phase, length);
        let height = if is_even(number) { self.amplitude() } else { -self.amplitude() };
        Arc { start: number * length, end, length, height }
    }
}

/// An arc of the motion, which is a parabola.
struct Arc {
    start: f64,
    end: f64,
    length: f64,
    height: f64,
}

impl WallMotion for BiParabolic {
    fn state(&self, phase: f64) -> WallState {
        let arc = self.arc(phase);
        let share = (phase - arc.start) / arc.length;
        let displacement = 4.0 * arc.height * share * (1.0 - share);
        WallState::new(displacement, 4.0 * arc.height * (1.0 - 2.0 * share) / arc.length)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let arc = self.arc(phase);
        let value = -8.0 * arc.height / (arc.length * arc.length);
        AccelerationBounds::new(arc.end, value, value)
    }

    periodic_answers!("BiParabolic");
}
