//! Wall motions that break their contract.

use std::f64::consts::TAU;

use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Combined, Sawtooth, Sinusoidal, WallMotion, WallState, laws,
};

use crate::Half::{Blind, Honest, Informed};
use crate::{Fault, judge, one_in};

const AMPLITUDE: f64 = 0.1;
const FREQUENCY: f64 = 10.0;
const PERIOD: f64 = TAU / FREQUENCY;

type Change<T> = Box<dyn Fn(&mut T, f64) + Send + Sync>;

/// An honest motion, some of whose answers are changed.
struct Altered {
    honest: Box<dyn WallMotion + Send + Sync>,
    state: Change<WallState>,
    bounds: Change<AccelerationBounds>,
    reach: (f64, f64),
    period: Option<f64>,
    jumps: bool,
}

impl Altered {
    fn new(honest: impl WallMotion + Send + Sync + 'static) -> Self {
        let (reach, period, jumps) = (honest.reach(), honest.period(), honest.jumps());
        let (state, bounds) = (Box::new(|_: &mut _, _| ()), Box::new(|_: &mut _, _| ()));
        Self { honest: Box::new(honest), state, bounds, reach, period, jumps }
    }

    fn state(self, change: impl Fn(&mut WallState, f64) + Send + Sync + 'static) -> Self {
        Self { state: Box::new(change), ..self }
    }

    fn bounds(self, change: impl Fn(&mut AccelerationBounds, f64) + Send + Sync + 'static) -> Self {
        Self { bounds: Box::new(change), ..self }
    }

    fn reach(self, low: f64, high: f64) -> Self {
        Self { reach: (low, high), ..self }
    }

    fn period(self, period: f64) -> Self {
        Self { period: Some(period), ..self }
    }
}

impl WallMotion for Altered {
    fn state(&self, phase: f64) -> WallState {
        let mut state = self.honest.state(phase);
        (self.state)(&mut state, phase);
        state
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let mut bounds = self.honest.acceleration(phase);
        (self.bounds)(&mut bounds, phase);
        bounds
    }

    fn reach(&self) -> (f64, f64) {
        self.reach
    }

    fn period(&self) -> Option<f64> {
        self.period
    }

    fn jumps(&self) -> bool {
        self.jumps
    }
}

fn parabolic() -> Altered {
    Altered::new(BiParabolic::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

fn harmonic() -> Altered {
    Altered::new(Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

fn sawtooth() -> Altered {
    Altered::new(Sawtooth::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

/// Returns the share of the period that has passed.
fn share(phase: f64) -> f64 {
    (phase / PERIOD).rem_euclid(1.0)
}

/// Scales the bounds to a part of their range.
fn narrowed(lower: f64, upper: f64) -> impl Fn(&mut AccelerationBounds, f64) + Send + Sync {
    move |bounds, _| (bounds.min, bounds.max) = (lower * bounds.min, upper * bounds.max)
}

fn places() -> Vec<Fault<Altered>> {
    vec![
        Fault(
            Blind,
            "the velocity is larger than the derivative by 1e-5",
            harmonic().state(|state, _| state.velocity *= 1.0 + 1e-5),
        ),
        Fault(
            Informed,
            "the velocity is 1 % too small for 1e-4 of the period",
            harmonic().state(|state, phase| {
                state.velocity *= if (0.4..0.4001).contains(&share(phase)) { 0.99 } else { 1.0 };
            }),
        ),
        Fault(
            Informed,
            "the displacement has steps of a millionth",
            harmonic().state(|state, _| {
                state.displacement = (state.displacement * 1e7).round() / 1e7;
            }),
        ),
        Fault(
            Blind,
            "a sawtooth falls slowly and jumps up",
            sawtooth().state(|state, _| {
                *state = WallState::new(-state.displacement, -state.velocity);
            }),
        ),
        Fault(Blind, "a sawtooth does not say that it jumps", Altered { jumps: false, ..sawtooth() }),
        Fault(
            Informed,
            "half a period is higher by 1e-11 of the amplitude",
            parabolic().state(|state, phase| {
                state.displacement -= if share(phase) < 0.5 { 1e-11 * AMPLITUDE } else { 0.0 };
            }),
        ),
        Fault(
            Blind,
            "the reach is too small by 1e-6",
            harmonic().reach(-AMPLITUDE * (1.0 - 1e-6), AMPLITUDE),
        ),
        Fault(
            Informed,
            "the wall is beyond its reach for 1e-3 of the period",
            parabolic().state(|state, phase| {
                state.displacement *= if (0.2495..0.2505).contains(&share(phase)) { 1.0 + 1e-6 } else { 1.0 };
            }),
        ),
        Fault(
            Blind,
            "the displacement is not a number at phase 0",
            parabolic().state(|state, phase| {
                state.displacement *= 0.0 / phase + 1.0;
            }),
        ),
        Fault(
            Informed,
            "the velocity at negative phases is not a number",
            harmonic().state(|state, phase| {
                state.velocity += 0.0 * phase.sqrt();
            }),
        ),
    ]
}

fn periods_and_bounds() -> Vec<Fault<Altered>> {
    let sine = Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude");
    let delayed = Combined::new(sine).delayed_until(1.0).expect("a start");
    vec![
        Fault(Blind, "the period is too long by 1e-6", harmonic().period(PERIOD * (1.0 + 1e-6))),
        Fault(Blind, "a motion that starts late has a period", Altered::new(delayed).period(PERIOD)),
        Fault(
            Informed,
            "each fifth period is lower by a hundredth",
            parabolic().state(|state, phase| {
                if (phase / PERIOD).rem_euclid(5.0) >= 4.0 {
                    *state = WallState::new(0.99 * state.displacement, 0.99 * state.velocity);
                }
            }),
        ),
        Fault(
            Blind,
            "both bounds are too small by 1e-5",
            parabolic().bounds(narrowed(1.0 - 1e-5, 1.0 - 1e-5)),
        ),
        Fault(
            Informed,
            "the lower bound is too high by 1e-6 of the range",
            harmonic().bounds(|bounds, _| {
                bounds.min += 1e-6 * (bounds.max - bounds.min);
            }),
        ),
        Fault(
            Informed,
            "within a piece, the bounds are 0",
            harmonic().bounds(|bounds, phase| {
                let place = 16.0 * phase / PERIOD;
                if (place - place.round()).abs() > 1e-3 {
                    (bounds.min, bounds.max) = (0.0, 0.0);
                }
            }),
        ),
        Fault(
            Blind,
            "a piece ends at the phase asked for",
            harmonic().bounds(|bounds, phase| bounds.until = phase),
        ),
        Fault(
            Informed,
            "a piece lasts two arcs",
            parabolic().bounds(|bounds, _| bounds.until += 0.5 * PERIOD),
        ),
    ]
}

fn states() -> Vec<Fault<Altered>> {
    let [often, seldom] = [one_in(50), one_in(3000)];
    vec![
        Fault(
            Blind,
            "one answer in 50 is higher by 1e-3",
            parabolic().state(move |state, _| {
                state.displacement -= if often() { 1e-3 * AMPLITUDE } else { 0.0 };
            }),
        ),
        Fault(
            Informed,
            "one answer in 3000 is higher by 1e-3",
            parabolic().state(move |state, _| {
                state.displacement -= if seldom() { 1e-3 * AMPLITUDE } else { 0.0 };
            }),
        ),
        Fault(Honest, "parabolic", parabolic()),
        Fault(Honest, "harmonic", harmonic()),
        Fault(Honest, "sawtooth", sawtooth()),
    ]
}

#[test]
fn the_check_of_motions_finds_planted_faults() {
    let all = places().into_iter().chain(periods_and_bounds()).chain(states()).collect();
    // Twenty periods.
    judge("motion", all, |motion: Altered| laws::check(&motion, -1.0, 13.0));
}
