//! The first touch of a disk with a moving wall, against fine sampling of the gap: none missed, none early.

mod cost;
mod endless;
mod low_bounces;
mod motions;

use approx::assert_abs_diff_eq;
use std::f64::consts::TAU;

use granular_edmd::wall;
use granular_edmd::wall::{
    AccelerationBounds, Approach, BiParabolic, Combined, FirstTouch, Fixed, Sawtooth, Sinusoidal, Triangular,
    WallMotion, WallState,
};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Returns the time of the first touch, if there is one.
fn first_touch<M: WallMotion + ?Sized>(motion: &M, approach: &Approach, until: f64) -> Option<f64> {
    wall::first_touch(motion, approach, until).touch()
}

/// A motion that only gives a bound of its acceleration for all times, which is three times too large.
struct Loose(Sinusoidal);

impl WallMotion for Loose {
    fn state(&self, time: f64) -> WallState {
        self.0.state(time)
    }
    fn acceleration(&self, _time: f64) -> AccelerationBounds {
        let most = 3.0 * self.0.amplitude() * self.0.angular_frequency().powi(2);
        AccelerationBounds::new(f64::INFINITY, -most, most)
    }
    fn reach(&self) -> (f64, f64) {
        (-2.0 * self.0.amplitude(), 2.0 * self.0.amplitude())
    }
}

const AMPLITUDE: f64 = 0.3;
const FREQUENCY: f64 = 2.0;
const PERIOD: f64 = TAU / FREQUENCY;

fn motions() -> Vec<(&'static str, Box<dyn WallMotion>)> {
    vec![
        ("fixed", Box::new(Fixed)),
        ("bi-parabolic", Box::new(BiParabolic::new(AMPLITUDE, FREQUENCY).unwrap())),
        ("sinusoidal", Box::new(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap())),
        ("triangular", Box::new(Triangular::new(AMPLITUDE, FREQUENCY).unwrap())),
        ("sawtooth", Box::new(Sawtooth::new(AMPLITUDE, FREQUENCY).unwrap())),
        (
            "late",
            Box::new(Combined::new(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap()).starting_at(7.3).unwrap()),
        ),
        ("loose", Box::new(Loose(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap()))),
    ]
}

fn uniform(generator: &mut Xoshiro256PlusPlus, low: f64, high: f64) -> f64 {
    low + (high - low) * (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// A flight above a wall, in numbers of its own.
#[derive(Debug, Clone, Copy)]
struct Flight {
    start: f64,
    height: f64,
    velocity: f64,
    acceleration: f64,
}

impl Flight {
    /// Any flight that starts above the wall: pulled down, up or not at all, slow and fast.
    fn random(motion: &dyn WallMotion, generator: &mut Xoshiro256PlusPlus) -> Self {
        let start = uniform(generator, -2.0 * PERIOD, 2.0 * PERIOD);
        let above = uniform(generator, 0.0, 1.0).powi(4) * 3.0;
        Self {
            start,
            height: motion.state(start).displacement + above,
            velocity: 2.0 * uniform(generator, -1.0, 1.0).powi(3),
            acceleration: [-1.0, -0.1, 0.0, -0.02, 0.05][(generator.next_u64() % 5) as usize],
        }
    }

    fn approach(&self) -> Approach {
        Approach::new(self.start, self.height, self.velocity, self.acceleration)
    }

    fn gap(&self, motion: &dyn WallMotion, time: f64) -> f64 {
        let t = time - self.start;
        self.height + (self.velocity + 0.5 * self.acceleration * t) * t - motion.state(time).displacement
    }

    fn rate(&self, motion: &dyn WallMotion, time: f64) -> f64 {
        self.velocity + self.acceleration * (time - self.start) - motion.state(time).velocity
    }
}

#[test]
fn no_touch_is_missed_and_none_is_early() {
    for (name, motion) in motions() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(11);
        let mut touches = 0;
        for case in 0..3000 {
            let flight = Flight::random(&motion, &mut generator);
            let until = flight.start + 3.0 * PERIOD;
            let touch = first_touch(&motion, &flight.approach(), until);
            // The gap is open all the time before, at thousands of times, and down to rounding.
            let end = touch.unwrap_or(until);
            for k in 0..2000 {
                let time = flight.start + (end - flight.start) * f64::from(k) / 2000.0;
                let gap = flight.gap(&motion, time);
                assert!(
                    gap > -1e-12,
                    "{name} {case}: missed at {time} (gap {gap:e}), found {touch:?} {flight:?}"
                );
            }
            if let Some(touch) = touch {
                touches += 1;
                let (gap, rate) = (flight.gap(&motion, touch), flight.rate(&motion, touch));
                assert!(gap.abs() < 2e-13, "{name} {case}: gap {gap:e} at the touch {touch} {flight:?}");
                assert!(rate < 1e-6, "{name} {case}: opens at {rate} {flight:?}");
            }
        }
        assert!((1000..3000).contains(&touches), "{name}: {touches}");
    }
}

#[test]
fn a_touching_start_counts_only_while_it_closes() {
    for (name, motion) in motions() {
        for k in 0..64 {
            // The start is off the ends of the pieces, where the velocity jumps.
            let start = PERIOD * (f64::from(k) + 0.37) / 64.0;
            let wall = motion.state(start);
            let from = |rate: f64, depth: f64| Flight {
                start,
                height: wall.displacement - depth,
                velocity: wall.velocity + rate,
                acceleration: -1.0,
            };
            for depth in [0.0, 1e-16, 1e-13] {
                let touch = |rate: f64| first_touch(&motion, &from(rate, depth).approach(), start + 50.0);
                assert_eq!(touch(-0.5), Some(start), "{name}: closing, {k} {depth:e}");
                let again = touch(0.5).unwrap();
                assert!(
                    again > start + 1e-3,
                    "{name}: receding, {k} {depth:e}, again after {}",
                    again - start
                );
            }
        }
    }
}

#[test]
fn a_touch_does_not_repeat_itself() {
    // The disk turns where it touches, and the search is asked again, as the engine does.
    for (name, motion) in motions() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(5);
        for case in 0..300 {
            let mut flight = Flight { acceleration: -1.0, ..Flight::random(&motion, &mut generator) };
            for _ in 0..30 {
                let touch = first_touch(&motion, &flight.approach(), flight.start + 100.0).unwrap();
                let rate = flight.rate(&motion, touch);
                let height = flight.gap(&motion, touch) + motion.state(touch).displacement;
                assert!(rate <= 0.0, "{name} {case} {rate:e}");
                let velocity = motion.state(touch).velocity - rate;
                let again =
                    first_touch(&motion, &Approach::new(touch, height, velocity, -1.0), touch + 100.0);
                let wait = again.unwrap() - touch;
                // The plate can catch up with a disk that leaves slowly, but not at once.
                assert!(rate > -1e-3 || wait > 1e-5, "{name} {case}: {rate} again after {wait:e}");
                flight = Flight { start: touch, height, velocity, acceleration: -1.0 };
            }
        }
    }
}

#[test]
fn a_limit_in_time_is_kept() {
    for (name, motion) in motions() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(7);
        for _ in 0..500 {
            let flight = Flight { acceleration: -1.0, ..Flight::random(&motion, &mut generator) };
            let touch = first_touch(&motion, &flight.approach(), f64::INFINITY).unwrap();
            assert_eq!(first_touch(&motion, &flight.approach(), touch), Some(touch), "{name}");
            let before = touch - 1e-9 * touch.abs().max(1.0);
            assert_eq!(first_touch(&motion, &flight.approach(), before), None, "{name}");
        }
    }
}

#[test]
fn late_times_cost_digits_of_time_and_nothing_else() {
    for (name, motion) in motions() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
        for late in [1e3, 1e6, 1e9] {
            for case in 0..300 {
                let early = Flight::random(&motion, &mut generator);
                let start = early.start + late;
                let above = early.height - motion.state(early.start).displacement;
                let flight = Flight { start, height: motion.state(start).displacement + above, ..early };
                let until = start + 3.0 * PERIOD;
                let touch = first_touch(&motion, &flight.approach(), until);
                let tolerance = 30.0 * f64::EPSILON * late + 1e-12;
                for k in 0..300 {
                    let time = start + (touch.unwrap_or(until) - start) * f64::from(k) / 300.0;
                    assert!(
                        flight.gap(&motion, time) > -tolerance,
                        "{name} {late:e} {case}: missed {flight:?}"
                    );
                }
                if let Some(touch) = touch {
                    let gap = flight.gap(&motion, touch);
                    assert!(gap.abs() < tolerance, "{name} {late:e} {case}: {gap:e} {flight:?}");
                }
            }
        }
    }
}

/// The flights have values that no sane flight has. The search must end, and never answer with a time outside
/// its limits.
#[test]
fn hostile_flights_end() {
    let hostile = [
        0.0,
        -0.0,
        1e-300,
        -1e-300,
        1e-9,
        -1e-9,
        1.0,
        -1.0,
        1e9,
        -1e9,
        1e140,
        -1e140,
        f64::INFINITY,
        f64::NAN,
    ];
    for (name, motion) in motions() {
        for start in [0.0, -1e5, 1e15, 1e300] {
            for height in hostile {
                for velocity in hostile {
                    for acceleration in [0.0, -1.0, 1.0, -1e140, 1e140, 1e-300, -1e-300, f64::NAN] {
                        let approach = Approach::new(start, height, velocity, acceleration);
                        // A surface that outruns the wall from far below, or hovers in a reach that is too
                        // large, is followed for as long as it takes.
                        let is_followed = height < -1.0 || name == "loose";
                        let end = if is_followed { start + 1e3 } else { f64::INFINITY };
                        for end in [start + 10.0, end] {
                            if let Some(touch) = first_touch(&motion, &approach, end) {
                                assert!(
                                    (start..=end).contains(&touch) && touch < f64::INFINITY,
                                    "{name} {start} {height} {velocity} {acceleration}: {touch}"
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn motions_that_break_their_contract_do_not_hang_the_search() {
    /// A motion whose pieces end before they begin.
    struct Backward(f64);
    impl WallMotion for Backward {
        fn state(&self, _: f64) -> WallState {
            WallState::new(0.0, 0.0)
        }
        fn acceleration(&self, time: f64) -> AccelerationBounds {
            AccelerationBounds::new(self.0 * time, -1.0, 1.0)
        }
        fn reach(&self) -> (f64, f64) {
            (-1.0, 1.0)
        }
    }
    for backward in [1.0, 0.5, f64::NAN, f64::NEG_INFINITY] {
        for height in [0.5, 0.0, -0.5, f64::NAN] {
            for velocity in [0.0, 1.0, -1.0] {
                for end in [100.0, f64::INFINITY] {
                    let approach = Approach::new(1.0, height, velocity, -1.0);
                    let answer = wall::first_touch(&Backward(backward), &approach, end);
                    // The surface is within the reach from the start, so the search gets no further.
                    assert_eq!(answer, FirstTouch::NotBefore(1.0), "{backward} {height} {velocity}");
                }
            }
        }
    }
}

#[test]
fn a_wall_too_fast_for_the_times_stops_the_search_within_its_reach() {
    let time = |answer: FirstTouch<f64>| match answer {
        FirstTouch::At(time) | FirstTouch::NotBefore(time) => time,
    };
    for frequency in [1e12, 1e20, 1e100] {
        let motions: [Box<dyn WallMotion>; 4] = [
            Box::new(BiParabolic::new(AMPLITUDE, frequency).unwrap()),
            Box::new(Sinusoidal::new(AMPLITUDE, frequency).unwrap()),
            Box::new(Triangular::new(AMPLITUDE, frequency).unwrap()),
            Box::new(Sawtooth::new(AMPLITUDE, frequency).unwrap()),
        ];
        let falling = |start: f64| Approach::new(start, AMPLITUDE + 1.0, -1.0, 0.0);
        let hovering = |start: f64| Approach::new(start, 0.0, 0.0, 0.0);
        let leaving = |start: f64| Approach::new(start, AMPLITUDE + 1e-9, 1.0, 0.0);
        for (motion, start) in motions.iter().flat_map(|motion| [1e6, 1e9, 1e15].map(|start| (motion, start)))
        {
            for end in [start + 100.0, f64::INFINITY] {
                let found = time(wall::first_touch(motion, &falling(start), end));
                assert!((start + 1.0..start + 2.0).contains(&found), "{frequency:e}: {found}");
                let found = time(wall::first_touch(motion, &hovering(start), end));
                assert!((start..start + 1e-9 * start).contains(&found), "{frequency:e}: {found}");
                assert_eq!(first_touch(motion, &leaving(start), end), None, "{frequency:e}");
            }
        }
    }
}

#[test]
fn a_search_without_an_end_ends_with_the_flight() {
    let wall = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    let never =
        |height, velocity| first_touch(&wall, &Approach::new(0.0, height, velocity, 0.0), f64::INFINITY);
    assert_eq!(never(0.4, 0.0), None, "it hovers out of reach");
    assert_eq!(never(0.0, 9.0), None, "it leaves");
    let slow = never(1e3, -1e-3).unwrap();
    assert!((slow - 999_700.0).abs() < PERIOD, "{slow}");
    for height in [0.0, -1.0] {
        let resting = Approach::new(0.0, height, 0.0, 0.0);
        assert_eq!(first_touch(&Fixed, &resting, f64::INFINITY), None, "it rests, and nothing closes");
    }
}

#[test]
fn a_disk_that_hovers_just_above_the_reach_of_a_sine_ends() {
    // The disk never touches, but for a moment in each period the gap is down to rounding.
    let base = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    for above in [1e-15, 1e-16, 0.0, 1e-12, 1e-9] {
        let hovering = Approach::new(0.0, AMPLITUDE + above, 0.0, 0.0);
        if let Some(touch) = first_touch(&base, &hovering, 1000.0) {
            assert!(above < 1e-14);
            assert_abs_diff_eq!(base.state(touch).displacement, AMPLITUDE, epsilon = 1e-14);
        }
    }
}
