//! A wall motion.

use granular_edmd::Fingerprint;
use granular_edmd::wall::{AccelerationBounds, WallMotion, WallState};

/// The sum of two sines whose frequencies need not fit together. It has no period, and knows only one bound
/// of its acceleration for all times.
#[derive(Debug, Clone, Copy)]
pub struct TwoSines {
    pub amplitudes: [f64; 2],
    pub frequencies: [f64; 2],
}

impl TwoSines {
    fn sum(&self, term: impl Fn(f64, f64) -> f64) -> f64 {
        self.amplitudes.iter().zip(&self.frequencies).map(|(&a, &w)| term(a, w)).sum()
    }
}

impl WallMotion for TwoSines {
    fn state(&self, phase: f64) -> WallState {
        WallState::new(
            self.sum(|a, w| a * libm::sin(w * phase)),
            self.sum(|a, w| a * w * libm::cos(w * phase)),
        )
    }

    fn acceleration(&self, _phase: f64) -> AccelerationBounds {
        let most = self.sum(|a, w| a.abs() * w * w);
        AccelerationBounds::new(f64::INFINITY, -most, most)
    }

    fn reach(&self) -> (f64, f64) {
        let most = self.sum(|a, _| a.abs());
        (-most, most)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let numbers = self.amplitudes.iter().chain(&self.frequencies);
        Some(numbers.fold(Fingerprint::of("TwoSines"), |print, &number| print.number(number)))
    }
}
