//! Motions that break their contract where a check may not look.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicU64, Ordering};

use granular_edmd::wall::{AccelerationBounds, BiParabolic, Sawtooth, Sinusoidal, WallMotion, WallState};

use crate::faults::blind::motions::Motion;
use crate::faults::{List, Planted, tenth};

const AMPLITUDE: f64 = 0.1;
const PERIOD: f64 = TAU / 10.0;

type Change<T> = Box<dyn Fn(&mut T, f64) + Send + Sync>;

/// A motion, some of whose answers are changed.
struct Changed {
    honest: Motion,
    state: Change<WallState>,
    bounds: Change<AccelerationBounds>,
    reach: f64,
    period: Option<f64>,
    jumps: bool,
}

impl WallMotion for Changed {
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
        (-self.reach, self.reach)
    }

    fn period(&self) -> Option<f64> {
        self.period
    }

    fn jumps(&self) -> bool {
        self.jumps
    }
}

fn changed(honest: impl WallMotion + Send + Sync + 'static) -> Changed {
    let (period, jumps) = (honest.period(), honest.jumps());
    let honest = Box::new(honest);
    let (state, bounds) = (Box::new(|_: &mut _, _| ()), Box::new(|_: &mut _, _| ()));
    Changed { honest, state, bounds, reach: AMPLITUDE, period, jumps }
}

fn harmonic() -> Changed {
    changed(Sinusoidal::new(AMPLITUDE, 10.0).expect("an amplitude"))
}

fn parabolic() -> Changed {
    changed(BiParabolic::new(AMPLITUDE, 10.0).expect("an amplitude"))
}

fn share(phase: f64) -> f64 {
    (phase / PERIOD).rem_euclid(1.0)
}

type Motions = List<Motion>;

impl Motions {
    fn with_state<F>(&mut self, family: &'static str, name: impl Into<String>, motion: Changed, change: F)
    where
        F: Fn(&mut WallState, f64) + Send + Sync + 'static,
    {
        self.family = family;
        self.plant(name, Box::new(Changed { state: Box::new(change), ..motion }));
    }

    fn with_bounds<F>(&mut self, family: &'static str, name: impl Into<String>, motion: Changed, change: F)
    where
        F: Fn(&mut AccelerationBounds, f64) + Send + Sync + 'static,
    {
        self.family = family;
        self.plant(name, Box::new(Changed { bounds: Box::new(change), ..motion }));
    }
}

pub(crate) fn catalogue() -> Vec<Planted<Motion>> {
    List::grown(&[integrals, periods, places, bounds, extremes])
}

/// The motion A(1 − cos ωt) in pieces of some half periods, with exact bounds: the acceleration is largest at
/// the ends of each half period.
#[derive(Clone, Copy)]
struct Raised {
    frequency: f64,
    halves: f64,
    /// Ends after the first half period, and rests outside of it.
    is_ramp: bool,
}

impl WallMotion for Raised {
    fn state(&self, phase: f64) -> WallState {
        let end = if self.is_ramp { PI / self.frequency } else { f64::INFINITY };
        let start = if self.is_ramp { 0.0 } else { f64::NEG_INFINITY };
        let angle = self.frequency * phase.clamp(start, end);
        let velocity = AMPLITUDE * self.frequency * angle.sin();
        let moves = (start..end).contains(&phase);
        WallState::new(AMPLITUDE * (1.0 - angle.cos()), if moves { velocity } else { 0.0 })
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let (piece, most) = (self.halves * PI / self.frequency, AMPLITUDE * self.frequency.powi(2));
        match self.is_ramp {
            true if phase < 0.0 => AccelerationBounds::new(0.0, 0.0, 0.0),
            true if phase >= PI / self.frequency => AccelerationBounds::new(f64::INFINITY, 0.0, 0.0),
            _ if piece == f64::INFINITY => AccelerationBounds::new(piece, -most, most),
            _ => {
                let next = ((phase / piece).floor() + 1.0) * piece;
                AccelerationBounds::new(if next > phase { next } else { next + piece }, -most, most)
            }
        }
    }

    fn reach(&self) -> (f64, f64) {
        (0.0, 2.0 * AMPLITUDE)
    }
}

fn raised() -> impl Iterator<Item = (String, Raised)> {
    [3.0, 10.0, 0.37].into_iter().flat_map(|frequency| {
        let of = move |halves, is_ramp| Raised { frequency, halves, is_ramp };
        let motions = [
            ("half a period", of(1.0, false)),
            ("one period", of(2.0, false)),
            ("seven periods", of(14.0, false)),
            ("one endless piece", of(f64::INFINITY, false)),
            ("a ramp", of(1.0, true)),
        ];
        motions.map(|(piece, motion)| (format!("frequency {frequency}, {piece}"), motion))
    })
}

/// Returns motions without a fault whose acceleration is largest where a piece ends.
pub(crate) fn honest() -> Vec<Planted<Motion>> {
    let mut motions = Motions::default();
    for (name, motion) in raised() {
        motions.plant(name, Box::new(motion));
    }
    motions.faults
}

fn extremes(motions: &mut Motions) {
    for (name, motion) in raised().filter(|(name, _)| !name.ends_with("endless piece")) {
        for (n, honest) in [(5, motion), (7, motion)] {
            let name = format!("{name}: both bounds are too small by 1e-{n}");
            let honest = Changed { reach: 2.0 * AMPLITUDE, ..changed(honest) };
            motions.with_bounds("largest at an end", name, honest, move |bounds, _| {
                (bounds.min, bounds.max) = ((1.0 - tenth(n)) * bounds.min, (1.0 - tenth(n)) * bounds.max);
            });
        }
    }
}

fn integrals(motions: &mut Motions) {
    for n in [2, 4, 6] {
        let name = format!("the velocity lacks 1e-{n} of itself on the way down");
        motions.with_state("half of the velocity", name, harmonic(), move |state, _| {
            if state.velocity < 0.0 {
                state.velocity *= 1.0 - tenth(n);
            }
        });
    }
    for width in [0.05, 0.01, 0.002, 0.0001] {
        let name = format!("the velocity is 1 % too small for {width} of the period");
        motions.with_state("narrow window", name, harmonic(), move |state, phase| {
            if (0.4..0.4 + width).contains(&share(phase)) {
                state.velocity *= 0.99;
            }
        });
    }
    motions.with_state(
        "drift",
        "the displacement drifts by 1e-7 of the amplitude each period",
        parabolic(),
        |state, phase| {
            state.displacement = 0.9 * state.displacement + 1e-8 * (phase / PERIOD);
        },
    );
    motions.with_state("steps", "the displacement has steps of a millionth", harmonic(), |state, _| {
        state.displacement = (state.displacement * 1e7).round() / 1e7;
    });
}

fn periods(motions: &mut Motions) {
    motions.with_state(
        "every second period",
        "each second period is lower by a hundredth",
        parabolic(),
        |state, phase| {
            if (phase / PERIOD).rem_euclid(2.0) >= 1.0 {
                *state = WallState::new(0.99 * state.displacement, 0.99 * state.velocity);
            }
        },
    );
    motions.with_state(
        "every fifth period",
        "each fifth period is lower by a hundredth",
        parabolic(),
        |state, phase| {
            if (phase / PERIOD).rem_euclid(5.0) >= 4.0 {
                *state = WallState::new(0.99 * state.displacement, 0.99 * state.velocity);
            }
        },
    );
    motions.with_state("late", "after 100 periods, the velocity is too small", harmonic(), |state, phase| {
        if phase > 100.0 * PERIOD {
            state.velocity *= 0.9;
        }
    });
    motions.with_state(
        "before zero",
        "at negative phases, the wall rests without saying it",
        harmonic(),
        |state, phase| {
            if phase < 0.0 {
                state.velocity = 0.0;
            }
        },
    );
}

fn places(motions: &mut Motions) {
    motions.with_state(
        "spike",
        "the wall is beyond its reach for 1e-3 of the period",
        parabolic(),
        |state, phase| {
            if (0.2495..0.2505).contains(&share(phase)) {
                state.displacement *= 1.0 + 1e-6;
            }
        },
    );
    motions.with_state(
        "small jump",
        "half a period is higher by 1e-11 of the amplitude",
        parabolic(),
        |state, phase| {
            if share(phase) < 0.5 {
                state.displacement -= 1e-11 * AMPLITUDE;
            }
        },
    );
    let silent = Changed { jumps: false, ..changed(Sawtooth::new(AMPLITUDE, 10.0).expect("an amplitude")) };
    motions.with_state(
        "silent jump",
        "a sawtooth of small teeth does not say that it jumps",
        Changed { reach: 1.0, ..silent },
        |_, _| (),
    );
    let calls = AtomicU64::new(0);
    motions.with_state("wear", "the wall sinks by 1e-13 with each question", parabolic(), move |state, _| {
        let calls = calls.fetch_add(1, Ordering::Relaxed) as f64;
        state.displacement = 0.9 * state.displacement - 1e-13 * calls;
    });
}

fn bounds(motions: &mut Motions) {
    for n in [2, 4, 6] {
        let name = format!("the lower bound at the end of a piece is too high by 1e-{n}");
        motions.with_bounds("lower bound", name, harmonic(), move |bounds, _| {
            bounds.min += tenth(n) * (bounds.max - bounds.min);
        });
    }
    motions.with_bounds(
        "question within",
        "asked within a piece, the bounds are 0",
        harmonic(),
        |bounds, phase| {
            let place = 16.0 * phase / PERIOD;
            if (place - place.round()).abs() > 1e-3 {
                (bounds.min, bounds.max) = (0.0, 0.0);
            }
        },
    );
    motions.with_bounds(
        "last piece",
        "the last piece of a period has the bounds of the first",
        harmonic(),
        |bounds, phase| {
            if share(phase) > 15.0 / 16.0 {
                (bounds.min, bounds.max) = (-bounds.max, -bounds.min);
            }
        },
    );
}
