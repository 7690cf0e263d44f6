//! Disks that rest on a wall, or leave it so slowly that the gap is lost in rounding.

use std::f64::consts::TAU;

use granular_edmd::wall::{Approach, Sinusoidal, Triangular, WallMotion, WallState};

use super::{AMPLITUDE, FREQUENCY, Flight, Loose, PERIOD, first_touch};

/// A disk leaves a sine so slowly that the whole bounce is lower than rounding. It ends when the gap closes
/// as fast as it opened.
#[test]
fn a_bounce_lower_than_rounding_takes_its_time() {
    let base = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    for k in 0..64 {
        let start = PERIOD * (f64::from(k) + 0.37) / 64.0;
        let WallState { displacement, velocity, .. } = base.state(start);
        for (rate, acceleration) in [(1e-9, -2.0), (1e-8, -2.0), (1e-8, -200.0)] {
            let flight = Flight { start, height: displacement, velocity: velocity + rate, acceleration };
            let touch = first_touch(&base, &flight.approach(), start + 1.0).unwrap();
            assert!((flight.rate(&base, touch) + rate).abs() < 1e-5 * rate, "{k} {rate:e}");
            assert_eq!(first_touch(&base, &flight.approach(), touch.next_down()), None, "{k} {rate:e}");
        }
    }
}

/// The wall falls away beyond its top. A disk that leaves it slowly meets it again when it comes up, not
/// before.
#[test]
fn a_wall_that_falls_away_is_not_touched_by_what_leaves_it() {
    let motion = Loose(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap());
    for (late, rate) in [(0.0, 0.0), (0.0, 1e-9), (0.0, 5e-8), (1e9, 0.0)] {
        let start = (late + 0.27) * PERIOD;
        let WallState { displacement: height, velocity, .. } = motion.state(start);
        let flight = Flight { start, height, velocity: velocity + rate, acceleration: 0.0 };
        let touch = first_touch(&motion, &flight.approach(), f64::INFINITY).unwrap();
        let gap = flight.gap(&motion, touch);
        assert!(
            touch > start + 1.0 && gap.abs() < 1e-12 + 30.0 * f64::EPSILON * start,
            "{late:e} {rate:e}: {gap:e}"
        );
    }
}

/// The wall falls away from the disk for a while, then less. A bounce that begins lower than rounding rises
/// far above it.
#[test]
fn a_bounce_that_begins_low_may_rise() {
    let base = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    let start = 0.376 * PERIOD;
    let WallState { displacement: height, velocity, .. } = base.state(start);
    let flight = Flight { start, height, velocity: velocity + 1e-9, acceleration: -0.5 };
    let touch = first_touch(&base, &flight.approach(), start + 1.0).unwrap();
    assert!(flight.gap(&base, start + 0.5 * (touch - start)) > 1e-4);
    assert!(flight.gap(&base, touch).abs() < 1e-14);
}

/// The rounding of a late time moves a slow surface by little.
#[test]
fn a_slow_disk_above_the_top_of_a_late_wall_touches_it_when_it_is_there() {
    let base = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    let start = 1e9 * PERIOD + 0.25 * PERIOD;
    let height = base.state(start).displacement + 1e-7;
    let flight = Flight { start, height, velocity: base.state(start).velocity - 1e-6, acceleration: -1.3 };
    let touch = first_touch(&base, &flight.approach(), start + 1.0).unwrap();
    assert!(touch > start && flight.gap(&base, touch).abs() < 1e-9);
}

#[test]
fn what_rests_on_a_wall_touches_it_and_what_rests_above_it_does_not() {
    let motion = Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap();
    let start = 0.1 * PERIOD;
    let WallState { displacement, velocity, .. } = motion.state(start);
    let touch = |above| {
        first_touch(&motion, &Approach::new(start, displacement + above, velocity, -2.0), start + 10.0)
    };
    assert_eq!(touch(0.0), Some(start));
    assert!(touch(0.05).unwrap() > start + 0.1);
    // A wall that comes exactly as far as the disk touches it.
    let triangular = Triangular::new(0.5, TAU).unwrap();
    assert_eq!(first_touch(&triangular, &Approach::new(0.0, 0.5, 0.0, 0.0), 10.0), Some(0.25));
}
