//! What the motions of walls say of themselves.

use std::f64::consts::TAU;

use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Sawtooth, Sinusoidal, Triangular, WallMotion, WallState,
};

use crate::{AMPLITUDE, FREQUENCY, Loose, PERIOD, motions};

/// All that a motion says of a time.
fn said<M: WallMotion>(motion: M) -> (WallState, AccelerationBounds, (f64, f64), Option<f64>) {
    (motion.state(0.4), motion.acceleration(0.4), motion.reach(), motion.period())
}

#[test]
fn a_motion_says_the_same_by_reference_and_in_a_box() {
    let motion = BiParabolic::new(AMPLITUDE, FREQUENCY).unwrap();
    let (_, _, reach, period) = said(motion);
    assert_eq!((motion.amplitude(), motion.angular_frequency()), (AMPLITUDE, FREQUENCY));
    assert_eq!((reach, period), ((-AMPLITUDE, AMPLITUDE), Some(PERIOD)));
    let (reference, boxed): (&dyn WallMotion, Box<dyn WallMotion>) = (&motion, Box::new(motion));
    assert_eq!(said(reference), said(motion));
    assert_eq!(said(boxed), said(motion));
    assert_eq!(Loose(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap()).period(), None, "unless it says so");
}

#[test]
fn every_motion_keeps_its_contract() {
    for (name, motion) in motions() {
        let (low, high) = motion.reach();
        let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
        for k in -480..480 {
            let time = PERIOD * (f64::from(k) + 0.25) / 160.0;
            let (now, bounds) = (motion.state(time), motion.acceleration(time));
            assert!((low..=high).contains(&now.displacement), "{name} {time}");
            ends = (ends.0.min(now.displacement), ends.1.max(now.displacement));
            // Half way to the end of the piece, or a little.
            let wait = (0.5 * (bounds.until - time)).min(1e-3);
            assert!(wait > 0.0, "{name} {time}");
            let next = motion.state(time + wait);
            let (rise, gain) = (next.displacement - now.displacement, next.velocity - now.velocity);
            assert!((0.5 * (now.velocity + next.velocity) * wait - rise).abs() < 1e-9, "{name} {time}");
            let allowed = bounds.min * wait - 1e-12..=bounds.max * wait + 1e-12;
            assert!(allowed.contains(&gain), "{name} {time}: {gain:e} in {wait:e}");
            if let Some(period) = motion.period() {
                let later = motion.state(time + period);
                assert!((later.displacement - now.displacement).abs() < 1e-13, "{name} {time}");
                assert!((later.velocity - now.velocity).abs() < 1e-13, "{name} {time}");
            }
        }
        if name != "loose" {
            assert!((ends.0 - low).max(high - ends.1) < 0.01 * AMPLITUDE, "{name} {ends:?}");
            let late = (1e9 + 0.1) % motion.period().unwrap();
            assert!(if name == "fixed" { late < 1e-300 } else { late < PERIOD }, "{name} {late}");
        }
    }
}

#[test]
fn the_bi_parabolic_base_is_its_formula() {
    let base = BiParabolic::new(AMPLITUDE, FREQUENCY).unwrap();
    for step in -100..100 {
        let time = 0.137 * f64::from(step);
        let s = (2.0 * time / PERIOD).rem_euclid(2.0);
        let (sign, s) = if s < 1.0 { (1.0, s) } else { (-1.0, s - 1.0) };
        let WallState { displacement, velocity } = base.state(time);
        assert!((displacement - sign * 4.0 * AMPLITUDE * s * (1.0 - s)).abs() < 1e-13, "{time}");
        assert!((velocity - sign * 8.0 * AMPLITUDE / PERIOD * (1.0 - 2.0 * s)).abs() < 1e-13, "{time}");
    }
}

#[test]
fn walls_of_constant_speed_rise_and_fall_as_they_should() {
    let (triangular, sawtooth) = (Triangular::new(0.5, TAU).unwrap(), Sawtooth::new(0.5, TAU).unwrap());
    let state = |displacement, velocity| WallState { displacement, velocity };
    for period in [-3.0, 0.0, 2.0] {
        let times = [0.0, 0.125, 0.5, 0.75].map(|time| period + time);
        let folded = [state(-0.5, 2.0), state(-0.25, 2.0), state(0.5, -2.0), state(0.0, -2.0)];
        assert_eq!(times.map(|time| triangular.state(time)), folded);
        let torn = [-0.5, -0.375, 0.0, 0.25].map(|displacement| state(displacement, 1.0));
        assert_eq!(times.map(|time| sawtooth.state(time)), torn);
    }
}
