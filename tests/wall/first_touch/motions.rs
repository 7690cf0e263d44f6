//! The answers that wall motions give about themselves.

use std::f64::consts::TAU;

use std::sync::Arc;

use granular_edmd::Fingerprint;
use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion, WallState,
    check_finite, laws,
};

use super::{AMPLITUDE, FREQUENCY, Loose, PERIOD, motions};

/// Returns everything that a motion answers about a time.
fn said<M: WallMotion>(
    motion: M,
) -> (WallState, AccelerationBounds, (f64, f64), Option<f64>, Option<Fingerprint>) {
    (motion.state(0.4), motion.acceleration(0.4), motion.reach(), motion.period(), motion.fingerprint())
}

#[test]
fn a_motion_says_the_same_by_reference_in_a_box_and_shared() {
    let motion = BiParabolic::new(AMPLITUDE, FREQUENCY).unwrap();
    let (_, _, reach, period, _) = said(motion);
    assert_eq!((motion.amplitude(), motion.angular_frequency()), (AMPLITUDE, FREQUENCY));
    assert_eq!((reach, period), ((-AMPLITUDE, AMPLITUDE), Some(PERIOD)));
    let (reference, boxed): (&dyn WallMotion, Box<dyn WallMotion>) = (&motion, Box::new(motion));
    let shared: Arc<dyn WallMotion> = Arc::new(motion);
    assert_eq!(said(reference), said(motion));
    assert_eq!(said(boxed), said(motion));
    assert_eq!(said(shared), said(motion));
    assert_eq!(Loose(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap()).period(), None, "unless it says so");
}

#[test]
fn every_motion_keeps_its_contract() {
    for (name, motion) in motions() {
        for from in [-9.5 * PERIOD, 0.0, 0.3, 1e6] {
            assert_eq!(laws::check(&motion, from, from + 3.0 * PERIOD), Ok(()), "{name} {from}");
        }
        assert_eq!(check_finite(&motion), Ok(()), "{name}");
    }
}

#[test]
fn every_motion_gets_as_far_as_it_reaches() {
    for (name, motion) in motions().into_iter().filter(|&(name, _)| name != "loose") {
        let places = (0..1600).map(|k| motion.state(PERIOD * f64::from(k) / 1600.0).displacement);
        let (low, high) = places
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| (place.min(low), place.max(high)));
        let reach = motion.reach();
        assert!((low - reach.0).max(reach.1 - high) < 0.01 * AMPLITUDE, "{name} {low} {high}");
    }
}

/// A wall that never moves has no period, and needs none: no answer depends on the time.
#[test]
fn a_fixed_wall_has_no_period() {
    assert_eq!((Fixed.period(), Fixed.reach()), (None, (0.0, 0.0)));
}

#[test]
fn motions_with_other_numbers_or_names_have_other_fingerprints() {
    let new = |amplitude, frequency| {
        [
            BiParabolic::new(amplitude, frequency).unwrap().fingerprint(),
            Sinusoidal::new(amplitude, frequency).unwrap().fingerprint(),
            Triangular::new(amplitude, frequency).unwrap().fingerprint(),
            Sawtooth::new(amplitude, frequency).unwrap().fingerprint(),
            Fixed.fingerprint(),
        ]
    };
    assert_eq!(new(0.1, 3.0), new(0.1, 3.0));
    let (mut all, others) =
        (new(0.1, 3.0).to_vec(), [new(0.2, 3.0), new(0.1, 4.0)].map(|all| all[..4].to_vec()));
    all.extend(others.concat());
    assert!(all.iter().all(Option::is_some));
    assert!((0..all.len()).all(|k| !all[..k].contains(&all[k])), "{all:?}");
    assert_eq!(
        Loose(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap()).fingerprint(),
        None,
        "unless it says so"
    );
}

#[test]
fn the_bi_parabolic_base_is_its_formula() {
    let base = BiParabolic::new(AMPLITUDE, FREQUENCY).unwrap();
    for step in -100..100 {
        let time = 0.137 * f64::from(step);
        let s = (2.0 * time / PERIOD).rem_euclid(2.0);
        let (sign, s) = if s < 1.0 { (1.0, s) } else { (-1.0, s - 1.0) };
        let WallState { displacement, velocity, .. } = base.state(time);
        assert!((displacement - sign * 4.0 * AMPLITUDE * s * (1.0 - s)).abs() < 1e-13, "{time}");
        assert!((velocity - sign * 8.0 * AMPLITUDE / PERIOD * (1.0 - 2.0 * s)).abs() < 1e-13, "{time}");
    }
}

#[test]
fn walls_of_constant_speed_rise_and_fall_as_they_should() {
    let (triangular, sawtooth) = (Triangular::new(0.5, TAU).unwrap(), Sawtooth::new(0.5, TAU).unwrap());
    let state = |displacement, velocity| WallState::new(displacement, velocity);
    for period in [-3.0, 0.0, 2.0] {
        let times = [0.0, 0.125, 0.5, 0.75].map(|time| period + time);
        let folded = [state(0.0, 2.0), state(0.25, 2.0), state(0.0, -2.0), state(-0.5, 2.0)];
        assert_eq!(times.map(|time| triangular.state(time)), folded);
        let torn = [0.0, 0.125, -0.5, -0.25].map(|displacement| state(displacement, 1.0));
        assert_eq!(times.map(|time| sawtooth.state(time)), torn);
    }
}

/// All oscillations begin alike, so one can take the place of another at phase 0 without a jump.
#[test]
fn all_oscillations_rise_through_their_middle_at_phase_zero() {
    let motions: [Box<dyn WallMotion>; 4] = [
        Box::new(BiParabolic::new(0.5, 3.0).unwrap()),
        Box::new(Sinusoidal::new(0.5, 3.0).unwrap()),
        Box::new(Triangular::new(0.5, 3.0).unwrap()),
        Box::new(Sawtooth::new(0.5, 3.0).unwrap()),
    ];
    for motion in motions {
        assert!(motion.state(0.0).displacement == 0.0 && motion.state(0.0).velocity > 0.0);
        assert!(motion.state(0.1).displacement > 0.0 && motion.state(-0.1).displacement < 0.0);
    }
}
