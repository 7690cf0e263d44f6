//! Motions that would break every run, which the container refuses. The target `laws` plants the other faults
//! that the check of motions must find.

use std::error::Error;

use granular_edmd::Violation;
use granular_edmd::boundary::{Container, Wall, WallError};
use granular_edmd::wall::laws::check;
use granular_edmd::wall::{
    AccelerationBounds, BiParabolic, Combined, Fixed, Sinusoidal, WallMotion, WallState, check_finite,
};
use support::cases::few;

const AMPLITUDE: f64 = 0.1;
const FREQUENCY: f64 = 10.0;

/// A way to spoil a sine.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    SwappedBounds,
    PeriodValue(f64),
    Reach(f64, f64),
    /// Late in the period, the displacement is this.
    Displacement(f64),
    /// Late in the period, the velocity is this.
    VelocityValue(f64),
    /// Late in the period, the upper bound is this.
    UpperBound(f64),
    /// Late in the period, the lower bound is this.
    LowerBound(f64),
    /// Pieces end where they begin.
    StandingPieces,
    UntilNaN,
    /// Pieces end one digit after they begin.
    TinyPieces,
}

struct Spoilt(Sinusoidal, Fault);

fn spoilt(fault: Fault) -> Spoilt {
    Spoilt(Sinusoidal::new(AMPLITUDE, FREQUENCY).unwrap(), fault)
}

impl Spoilt {
    fn is_late(&self, phase: f64) -> bool {
        (phase / self.0.period().unwrap()).rem_euclid(1.0) > 0.7
    }
}

impl WallMotion for Spoilt {
    fn state(&self, phase: f64) -> WallState {
        let WallState { displacement, velocity, .. } = self.0.state(phase);
        match self.1 {
            Fault::Displacement(value) if self.is_late(phase) => WallState::new(value, velocity),
            Fault::VelocityValue(value) if self.is_late(phase) => WallState::new(displacement, value),
            _ => WallState::new(displacement, velocity),
        }
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let AccelerationBounds { until, min, max, .. } = self.0.acceleration(phase);
        match self.1 {
            Fault::SwappedBounds => AccelerationBounds::new(until, max, min),
            Fault::UpperBound(value) if self.is_late(phase) => AccelerationBounds::new(until, min, value),
            Fault::LowerBound(value) if self.is_late(phase) => AccelerationBounds::new(until, value, max),
            Fault::StandingPieces => AccelerationBounds::new(phase, min, max),
            Fault::UntilNaN => AccelerationBounds::new(f64::NAN, min, max),
            Fault::TinyPieces => AccelerationBounds::new(phase.next_up(), min, max),
            _ => AccelerationBounds::new(until, min, max),
        }
    }

    fn reach(&self) -> (f64, f64) {
        if let Fault::Reach(low, high) = self.1 { (low, high) } else { (-2.0 * AMPLITUDE, 2.0 * AMPLITUDE) }
    }

    fn period(&self) -> Option<f64> {
        if let Fault::PeriodValue(value) = self.1 { Some(value) } else { self.0.period() }
    }
}

fn verdict(fault: Fault) -> Result<(), Violation> {
    check(&spoilt(fault), 0.0, 2.0)
}

#[test]
fn a_sound_motion_passes() {
    assert_eq!(verdict(Fault::None), Ok(()));
    assert_eq!(check_finite(&spoilt(Fault::None)), Ok(()));
}

/// Returns faults each of which would let disks fall through the floor, or hang the search for a touch.
fn unusable() -> Vec<Fault> {
    let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|value| {
        [
            Fault::Displacement(value),
            Fault::VelocityValue(value),
            Fault::UpperBound(value),
            Fault::LowerBound(value),
            Fault::Reach(-0.1, value),
            Fault::Reach(value, 0.1),
            Fault::PeriodValue(value),
        ]
    });
    let others = [
        Fault::Reach(0.1, -0.1),
        Fault::PeriodValue(0.0),
        Fault::SwappedBounds,
        Fault::StandingPieces,
        Fault::UntilNaN,
        Fault::TinyPieces,
    ];
    not_finite.concat().into_iter().chain(others).collect()
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_the_container() {
    for fault in unusable() {
        let violation = check_finite(&spoilt(fault)).unwrap_err();
        assert!(verdict(fault).is_err(), "{fault:?}");
        let error = Container::closed(8.0, 9.0).unwrap().with_motion(Wall::Floor, spoilt(fault)).unwrap_err();
        // A violation by NaN is not equal to itself, so the violations are compared as text.
        let WallError::Motion { violation: ref told } = error else { panic!("{fault:?}: {error}") };
        assert_eq!(told.to_string(), violation.to_string());
        assert_eq!(error.to_string(), format!("the motion of the wall cannot be used: {violation}"));
        assert!(error.source().is_none(), "the message has it already");
    }
}

#[test]
fn a_missing_wall_is_named() {
    let error = Container::open(8.0).unwrap().with_motion(Wall::Lid, spoilt(Fault::None)).unwrap_err();
    assert_eq!(error, WallError::Missing { wall: Wall::Lid });
    assert_eq!(error.to_string(), "the container has no wall \"lid\"");
}

/// A motion with a start keeps the contract, and begins when it should, however late that is.
#[test]
fn motions_begin_at_their_start() {
    fn check_one(motion: impl WallMotion + Copy + Send + Sync + 'static) {
        for start in few([0.0, 1e-9, 0.7, -3.0, 628.318_530_7, 12_345.678, 1e9], 3) {
            let late = Combined::new(motion).starting_at(start).unwrap();
            check(&late, 0.0, 20.0).unwrap();
            let phase = motion.period().map_or(start, |period| start % period);
            for wait in [0.0, 0.1, 0.4] {
                let (now, then) = (late.state(phase + wait), motion.state(wait));
                let scale = if motion.period().is_some() { 1.0 } else { start.abs().max(1.0) };
                assert!((now.displacement - then.displacement).abs() < 1e-13 * scale, "{start} {wait}");
                assert!((now.velocity - then.velocity).abs() < 1e-12 * scale, "{start} {wait}");
            }
        }
        for bad in [f64::NAN, f64::INFINITY] {
            let error = Combined::new(motion).starting_at(bad).unwrap_err().to_string();
            assert!(error.starts_with("start of a motion must be finite"), "{error}");
        }
    }
    check_one(Sinusoidal::new(0.1, 7.3).unwrap());
    check_one(BiParabolic::new(0.1, 23.0).unwrap());
    check_one(Fixed);
}

#[cfg(feature = "serde")]
#[test]
fn motions_with_a_start_come_back_from_files() {
    use granular_edmd::boundary::Boundary;

    let base = Combined::new(BiParabolic::new(0.1, 10.0).unwrap()).starting_at(12.5).unwrap();
    let container = Container::open(4.0).unwrap().with_motion(Wall::Floor, base).unwrap();
    let text = serde_json::to_string(&container).unwrap();
    assert!(text.contains("12.5"), "{text}");
    let back: Container = serde_json::from_str(&text).unwrap();
    assert_eq!(back.fingerprint(), container.fingerprint());
    let bad = text.replace("12.5", "1e999");
    assert!(serde_json::from_str::<Container>(&bad).is_err());
}
