//! Wall motions that break their contract.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering};

use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Combined, Sawtooth, Sinusoidal, Triangular, WallMotion, WallState,
};

use crate::faults::{List, Planted, one_in, tenth};

pub(crate) type Motion = Box<dyn WallMotion + Send + Sync>;
type StateChange = Box<dyn Fn(&mut WallState, f64) + Send + Sync>;
type BoundsChange = Box<dyn Fn(&mut AccelerationBounds, f64) + Send + Sync>;

/// An honest motion, some of whose answers are changed.
struct Altered {
    honest: Motion,
    state: StateChange,
    bounds: BoundsChange,
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

const AMPLITUDE: f64 = 0.1;
const FREQUENCY: f64 = 10.0;
const PERIOD: f64 = TAU / FREQUENCY;

fn parabolic() -> Altered {
    Altered::new(BiParabolic::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

fn harmonic() -> Altered {
    Altered::new(Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

fn sawtooth() -> Altered {
    Altered::new(Sawtooth::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
}

/// Returns arcs that are higher by a factor at some phases, with bounds that are right.
fn amplified(factor: f64, is_there: fn(f64) -> bool) -> Altered {
    let at = move |phase: f64| if is_there(phase) { factor } else { 1.0 };
    let state = move |state: &mut WallState, phase: f64| {
        *state = WallState::new(at(phase) * state.displacement, at(phase) * state.velocity);
    };
    let bounds = move |bounds: &mut AccelerationBounds, phase: f64| {
        (bounds.min, bounds.max) = (at(phase) * bounds.min, at(phase) * bounds.max);
    };
    parabolic().state(state).bounds(bounds)
}

/// Returns the share of the period that has passed.
fn share(phase: f64) -> f64 {
    (phase / PERIOD).rem_euclid(1.0)
}

/// The catalogue while it grows.
type Motions = List<Motion>;

impl Motions {
    fn add(&mut self, name: impl Into<String>, motion: impl WallMotion + Send + Sync + 'static) {
        self.plant(name, Box::new(motion));
    }

    fn state<F>(&mut self, name: impl Into<String>, honest: Altered, change: F)
    where
        F: Fn(&mut WallState, f64) + Send + Sync + 'static,
    {
        self.add(name, honest.state(change));
    }

    fn bounds<F>(&mut self, name: impl Into<String>, honest: Altered, change: F)
    where
        F: Fn(&mut AccelerationBounds, f64) + Send + Sync + 'static,
    {
        self.add(name, honest.bounds(change));
    }
}

/// Returns the motions on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Motion>> {
    let mut motions = Motions::default();
    motions.add("parabolic", parabolic());
    motions.add("harmonic", harmonic());
    motions.add("sawtooth", sawtooth());
    motions.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Motion>> {
    List::grown(&[velocities, jumps, reaches, bounds, periods, pieces, numbers])
}

/// "The displacement is the integral of the velocity."
fn velocities(motions: &mut Motions) {
    motions.family = "velocity";
    for n in [1, 2, 3, 5, 7] {
        let (size, name) = (tenth(n), format!("the velocity is larger than the derivative by 1e-{n}"));
        motions.state(name, harmonic(), move |state, _| state.velocity *= 1.0 + size);
        let name = format!("the velocity is late by 1e-{n} of the period");
        let motion = Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude");
        let late = move |state: &mut WallState, phase: f64| {
            state.velocity = motion.state(phase - size * PERIOD).velocity;
        };
        motions.state(name, harmonic(), late);
    }
    motions.state("the velocity has the wrong sign", parabolic(), |state, _| state.velocity *= -1.0);
    motions.state("the velocity lacks the angular frequency", harmonic(), |state, _| {
        state.velocity /= FREQUENCY;
    });
    for (low, high) in [(0.3, 0.4), (0.617, 0.618)] {
        let name = format!("the velocity is 0 from {low} to {high} of each period");
        motions.state(name, parabolic(), move |state, phase| {
            if (low..high).contains(&share(phase)) {
                state.velocity = 0.0;
            }
        });
    }
    let late = |state: &mut WallState, phase: f64| {
        if phase > 10.0 * PERIOD {
            state.velocity *= 0.99;
        }
    };
    motions.state("the velocity is too small by a hundredth after ten periods", harmonic(), late);
}

/// "The displacement may jump there, too, but only away from the disks."
fn jumps(motions: &mut Motions) {
    motions.family = "jump";
    for n in [1, 3, 6, 9] {
        let (size, name) =
            (tenth(n) * AMPLITUDE, format!("half a period is higher by 1e-{n} of the amplitude"));
        let raised = Altered { jumps: true, ..parabolic() }.reach(-2.0 * AMPLITUDE, 2.0 * AMPLITUDE);
        motions.state(name, raised, move |state, phase| {
            if share(phase) >= 0.5 {
                state.displacement += size;
            }
        });
    }
    motions.state("the wall jumps down in the midst of a piece", parabolic(), |state, phase| {
        if share(phase) > 0.23 && share(phase) < 0.5 {
            state.displacement *= 0.9;
        }
    });
    let upside = Sawtooth::new(AMPLITUDE, FREQUENCY).expect("an amplitude");
    motions.state("a sawtooth falls slowly and jumps up", Altered::new(upside), |state, _| {
        *state = WallState::new(-state.displacement, -state.velocity);
    });
    motions.add("a sawtooth does not say that it jumps", Altered { jumps: false, ..sawtooth() });
    let shaken = Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude");
    let delayed = Altered::new(Combined::new(shaken).delayed_until(1.0).expect("a start"));
    motions.state("a wall that starts late lies lower before the start", delayed, |state, phase| {
        if phase < 1.0 {
            state.displacement = -0.5 * AMPLITUDE;
        }
    });
}

/// "The displacement lies within `reach`."
fn reaches(motions: &mut Motions) {
    motions.family = "reach";
    for n in [1, 3, 6, 9] {
        let reach = AMPLITUDE * (1.0 - tenth(n));
        motions.add(format!("the reach is too small by 1e-{n} above"), parabolic().reach(-AMPLITUDE, reach));
        motions.add(format!("the reach is too small by 1e-{n} below"), harmonic().reach(-reach, AMPLITUDE));
    }
    motions.add("the reach has its ends exchanged", parabolic().reach(AMPLITUDE, -AMPLITUDE));
    motions.add("the reach is the amplitude and not the range", harmonic().reach(0.0, AMPLITUDE));
    let is_high = |phase: f64| (phase / PERIOD).rem_euclid(20.0) >= 19.5;
    let rare = Altered { period: None, ..amplified(1.5, is_high) };
    motions.add("the wall leaves its reach below once in 20 periods", rare);
}

/// "Its bounds hold for the acceleration up to its end."
fn bounds(motions: &mut Motions) {
    motions.family = "bounds";
    for n in [1, 3, 5, 7] {
        let (size, name) = (tenth(n), format!("the bounds of a parabola are both too small by 1e-{n}"));
        motions.bounds(name, parabolic(), move |bounds, _| {
            (bounds.min, bounds.max) = ((1.0 - size) * bounds.min, (1.0 - size) * bounds.max);
        });
        let name = format!("the upper bound is too low by 1e-{n} of the range");
        motions.bounds(name, harmonic(), move |bounds, _| {
            bounds.max -= size * (bounds.max - bounds.min);
        });
    }
    motions.bounds("the lower bound is the acceleration in the middle", harmonic(), |bounds, _| {
        bounds.min = 0.5 * (bounds.min + bounds.max);
    });
    motions.bounds("the bounds are the values at the start of the piece", harmonic(), |bounds, phase| {
        let now = -AMPLITUDE * FREQUENCY * FREQUENCY * (FREQUENCY * phase).sin();
        (bounds.min, bounds.max) = (now, now);
    });
    motions.bounds("one piece in sixteen is said to be at constant speed", harmonic(), |bounds, phase| {
        if (share(phase) * 16.0).floor() == 5.0 {
            (bounds.min, bounds.max) = (0.0, 0.0);
        }
    });
    motions.bounds("the bounds have the wrong sign", parabolic(), |bounds, _| {
        (bounds.min, bounds.max) = (-bounds.max, -bounds.min);
    });
}

/// "If there is a period, the whole motion repeats after it."
fn periods(motions: &mut Motions) {
    motions.family = "period";
    for n in [1, 3, 6, 9] {
        let name = format!("the period is too long by 1e-{n}");
        motions.add(name, harmonic().period(PERIOD * (1.0 + tenth(n))));
    }
    motions.add("half of the period is given", parabolic().period(0.5 * PERIOD));
    motions.add("the frequency is given as the period", parabolic().period(FREQUENCY / TAU));
    motions.add("the period is 0", harmonic().period(0.0));
    motions.add("the period is negative", harmonic().period(-PERIOD));
    motions.add("the period is infinite", harmonic().period(f64::INFINITY));
    let delayed = Combined::new(Sinusoidal::new(AMPLITUDE, FREQUENCY).expect("an amplitude"))
        .delayed_until(1.0)
        .expect("a start");
    motions.add("a motion that starts late has a period", Altered::new(delayed).period(PERIOD));
    let tired = amplified(0.5, |phase| phase >= 7.0 * PERIOD);
    motions.add("the amplitude halves after 7 periods", tired);
}

/// "A piece ends later than the phase asked for."
fn pieces(motions: &mut Motions) {
    motions.family = "piece";
    motions.bounds("a piece ends at the phase asked for", harmonic(), |bounds, phase| {
        bounds.until = phase;
    });
    motions.bounds("a piece that is asked for at its start has ended", parabolic(), |bounds, phase| {
        let place = 2.0 * phase / PERIOD;
        if (place - place.round()).abs() < 1e-12 {
            bounds.until = place.round() * 0.5 * PERIOD;
        }
    });
    motions.bounds("the end of a piece is a duration and not a phase", harmonic(), |bounds, _| {
        bounds.until = PERIOD / 16.0;
    });
    motions.bounds("a piece never ends", harmonic(), |bounds, _| bounds.until = f64::INFINITY);
    motions.bounds("a piece lasts two arcs", parabolic(), |bounds, _| bounds.until += 0.5 * PERIOD);
    let triangular = Triangular::new(AMPLITUDE, FREQUENCY).expect("an amplitude");
    motions.bounds(
        "a piece goes on beyond a turn by 1e-6 of the period",
        Altered::new(triangular),
        |bounds, _| bounds.until += 1e-6 * PERIOD,
    );
}

/// "Finite numbers, and the same ones each time."
fn numbers(motions: &mut Motions) {
    motions.family = "number";
    motions.state("the displacement is not a number at phase 0", parabolic(), |state, phase| {
        state.displacement *= 0.0 / phase + 1.0;
    });
    motions.state("the velocity is not a number where it turns around", parabolic(), |state, phase| {
        let place = 2.0 * phase / PERIOD;
        if place == place.round() {
            state.velocity = f64::NAN;
        }
    });
    motions.state("the velocity at negative phases is not a number", harmonic(), |state, phase| {
        state.velocity += 0.0 * phase.sqrt();
    });
    motions.bounds("the upper bound is infinite", parabolic(), |bounds, _| bounds.max = f64::INFINITY);
    motions.family = "hidden state";
    for calls in [2, 50, 3_000] {
        let (is_due, name) = (one_in(calls), format!("one answer in {calls} is higher by 1e-3"));
        motions.state(name, parabolic(), move |state, _| {
            if is_due() {
                state.displacement -= 1e-3 * AMPLITUDE;
            }
        });
    }
    let last = AtomicU64::new(0);
    motions.state(
        "the answer to an earlier phase is that to the last one",
        harmonic(),
        move |state, phase| {
            let latest = f64::from_bits(last.load(Ordering::Relaxed)).max(phase);
            last.store(latest.to_bits(), Ordering::Relaxed);
            state.displacement = AMPLITUDE * (FREQUENCY * latest).sin();
        },
    );
}
