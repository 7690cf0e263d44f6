//! A base that began to oscillate at a later time than 0.

use granular_edmd::wall::{AccelerationBounds, BiParabolic, WallMotion, WallState};

/// The paper's base, with its phase 0 at a time of its own. A base of another frequency can then take over
/// where the one before it ended an oscillation, without a jump.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Later {
    base: BiParabolic,
    /// Phase of the base at time 0, in `[0, period)`.
    lead: f64,
}

impl Later {
    /// Creates a base that begins an oscillation at this time.
    pub(crate) fn new(base: BiParabolic, time: f64) -> Self {
        let period = std::f64::consts::TAU / base.angular_frequency();
        // The remainder is exact. At time 0 there is no lead, and the phases are those of the base itself.
        let past = time.rem_euclid(period);
        Self { base, lead: if past == 0.0 { 0.0 } else { period - past } }
    }
}

impl WallMotion for Later {
    fn state(&self, phase: f64) -> WallState {
        self.base.state(phase + self.lead)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let bounds = self.base.acceleration(phase + self.lead);
        let until = bounds.until - self.lead;
        if until > phase {
            return AccelerationBounds::new(until, bounds.min, bounds.max);
        }
        // The sum was rounded to just before the end of a piece, so the next piece is meant.
        let next = self.base.acceleration(bounds.until);
        AccelerationBounds::new(next.until - self.lead, next.min, next.max)
    }

    fn reach(&self) -> (f64, f64) {
        self.base.reach()
    }

    fn period(&self) -> Option<f64> {
        self.base.period()
    }
}

#[cfg(test)]
mod tests {
    use granular_edmd::wall::{BiParabolic, WallMotion, laws};

    use super::Later;

    #[test]
    fn it_keeps_the_contract_and_begins_when_it_should() -> Result<(), Box<dyn std::error::Error>> {
        for (frequency, time) in [(10.0, 0.0), (7.3, 628.318_530_7), (23.0, 1e-9), (3.1, 12_345.678)] {
            let base = Later::new(BiParabolic::new(0.1, frequency)?, time);
            laws::check(&base, 0.0, 20.0)?;
            let period = std::f64::consts::TAU / frequency;
            let state = base.state(time % period);
            assert!(state.displacement.abs() < 1e-9, "{frequency} {time}: {state:?}");
            assert!(state.velocity > 0.0);
        }
        Ok(())
    }
}
