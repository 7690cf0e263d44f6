//! Wall motions that break their contract.

use std::f64::consts::TAU;

use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Sawtooth, Sinusoidal, WallMotion, WallState, laws,
};

use crate::{Fault, blind, honest, informed, judge, one_in};

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
        blind(
            "the velocity is larger than the derivative by 1e-5",
            harmonic().state(|state, _| state.velocity *= 1.0 + 1e-5),
        ),
        informed(
            "the velocity is 1 % too small for 1e-4 of the period",
            harmonic().state(|state, phase| {
                state.velocity *= if (0.4..0.4001).contains(&share(phase)) { 0.99 } else { 1.0 };
            }),
        ),
        blind(
            "a sawtooth falls slowly and jumps up",
            sawtooth().state(|state, _| {
                *state = WallState::new(-state.displacement, -state.velocity);
            }),
        ),
        blind("a sawtooth does not say that it jumps", Altered { jumps: false, ..sawtooth() }),
        blind(
            "the reach is too small by 1e-6",
            Altered { reach: (-AMPLITUDE * (1.0 - 1e-6), AMPLITUDE), ..harmonic() },
        ),
        informed(
            "the wall is beyond its reach for 1e-3 of the period",
            parabolic().state(|state, phase| {
                state.displacement *= if (0.2495..0.2505).contains(&share(phase)) { 1.0 + 1e-6 } else { 1.0 };
            }),
        ),
        blind(
            "the displacement is not a number at phase 0",
            parabolic().state(|state, phase| {
                state.displacement *= 0.0 / phase + 1.0;
            }),
        ),
    ]
}

fn periods_and_bounds() -> Vec<Fault<Altered>> {
    let longer = Some(PERIOD * (1.0 + 1e-6));
    vec![
        blind("the period is too long by 1e-6", Altered { period: longer, ..harmonic() }),
        informed(
            "each fifth period is lower by a hundredth",
            parabolic().state(|state, phase| {
                if (phase / PERIOD).rem_euclid(5.0) >= 4.0 {
                    *state = WallState::new(0.99 * state.displacement, 0.99 * state.velocity);
                }
            }),
        ),
        blind("both bounds are too small by 1e-5", parabolic().bounds(narrowed(1.0 - 1e-5, 1.0 - 1e-5))),
        informed(
            "the lower bound is too high by 1e-6 of the range",
            harmonic().bounds(|bounds, _| {
                bounds.min += 1e-6 * (bounds.max - bounds.min);
            }),
        ),
        blind("a piece ends at the phase asked for", harmonic().bounds(|bounds, phase| bounds.until = phase)),
    ]
}

fn states() -> Vec<Fault<Altered>> {
    let [often, seldom] = [one_in(50), one_in(3000)];
    vec![
        blind(
            "one answer in 50 is higher by 1e-3",
            parabolic().state(move |state, _| {
                state.displacement -= if often() { 1e-3 * AMPLITUDE } else { 0.0 };
            }),
        ),
        informed(
            "one answer in 3000 is higher by 1e-3",
            parabolic().state(move |state, _| {
                state.displacement -= if seldom() { 1e-3 * AMPLITUDE } else { 0.0 };
            }),
        ),
        honest("parabolic", parabolic()),
        honest("harmonic", harmonic()),
        honest("sawtooth", sawtooth()),
    ]
}

#[test]
fn the_check_of_motions_finds_planted_faults() {
    let all = [places(), periods_and_bounds(), states()].into_iter().flatten().collect();
    // Twenty periods.
    judge("motion", all, |motion: Altered| laws::check(&motion, -1.0, 13.0));
}
