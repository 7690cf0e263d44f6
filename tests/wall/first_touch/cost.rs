//! The number of steps of a search, counted as the questions that it asks the motion.

use std::cell::Cell;

use granular_edmd::wall::{
    AccelerationBounds, Approach, BiParabolic, Sinusoidal, Triangular, WallMotion, WallState,
};
use rand::{RngExt, SeedableRng};

use super::{Xoshiro256PlusPlus, first_touch};

struct Counted<M>(M, Cell<u32>);

impl<M: WallMotion> WallMotion for Counted<M> {
    fn state(&self, phase: f64) -> WallState {
        self.0.state(phase)
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        self.1.set(self.1.get() + 1);
        self.0.acceleration(phase)
    }
    fn reach(&self) -> (f64, f64) {
        self.0.reach()
    }
    fn period(&self) -> Option<f64> {
        self.0.period()
    }
}

/// Returns the mean and the largest number of steps from a launch to the touch, under a weak gravity.
fn steps(motion: impl WallMotion, amplitude: f64) -> (f64, u32) {
    const FLIGHTS: u32 = 2000;
    let motion = Counted(motion, Cell::new(0));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let (mut sum, mut most) = (0, 0);
    for _ in 0..FLIGHTS {
        let phase = random.random::<f64>() * motion.period().unwrap();
        let height = amplitude + 10.0 * random.random::<f64>();
        let velocity = 2.0 * random.random::<f64>() - 1.0;
        motion.1.set(0);
        assert!(first_touch(&motion, &Approach::new(phase, height, velocity, -0.015_625), 1e12).is_some());
        sum += motion.1.get();
        most = most.max(motion.1.get());
    }
    (f64::from(sum) / f64::from(FLIGHTS), most)
}

/// At the smallest amplitude, a flight lasts ten million periods. docs/first-touch.md gives the counts.
#[test]
fn a_search_costs_the_same_at_any_frequency() {
    for exponent in 0..7 {
        let amplitude = libm::exp10(-f64::from(exponent));
        let frequency = 1.0 / amplitude;
        let sinusoid = steps(Sinusoidal::new(amplitude, frequency).unwrap(), amplitude);
        assert!(sinusoid.0 < 9.0 && sinusoid.1 <= 24, "{amplitude}: {sinusoid:?}");
        let arcs = steps(BiParabolic::new(amplitude, frequency).unwrap(), amplitude);
        let lines = steps(Triangular::new(amplitude, frequency).unwrap(), amplitude);
        assert!(arcs.0.max(lines.0) < 3.0 && arcs.1.max(lines.1) <= 4, "{amplitude}: {arcs:?} {lines:?}");
    }
}
