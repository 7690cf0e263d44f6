//! Motions that no search could follow. The search ends all the same, and lets nothing through.

use granular_edmd::wall::{AccelerationBounds, Approach, WallMotion, WallState, first_touch};

/// A wall at rest that lies about itself.
#[derive(Debug, Clone, Copy)]
struct Liar {
    state: WallState,
    reach: (f64, f64),
    bound: f64,
    /// Steps of the last digit in a piece; endless for none.
    digits: u32,
}

const HONEST: Liar = Liar { state: WallState::new(0.0, 0.0), reach: (-1.0, 1.0), bound: 1.0, digits: 0 };

impl WallMotion for Liar {
    fn state(&self, _: f64) -> WallState {
        self.state
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let until = (0..self.digits).fold(phase, |phase, _| phase.next_up());
        let until = if self.digits == 0 { f64::INFINITY } else { until };
        AccelerationBounds::new(until, -self.bound, self.bound)
    }
    fn reach(&self) -> (f64, f64) {
        self.reach
    }
}

/// A surface that hovers half a length above the wall's place, and one that sinks to it in five times.
fn approaches(start: f64) -> [Approach; 2] {
    [Approach::new(start, 0.5, 0.0, 0.0), Approach::new(start, 0.5, -0.1, 0.0)]
}

/// Checks that the search ends, and that the surface that sinks has not got past the wall unnoticed.
fn is_stopped(liar: Liar) {
    for start in [0.0, 1.0, 1e9, -3.0] {
        let [hovering, sinking] = approaches(start);
        for end in [start + 100.0, f64::INFINITY] {
            let touch = first_touch(&liar, &sinking, end);
            let is_stopped = touch.is_some_and(|touch| (start..=start + 5.0 + 1e-5).contains(&touch));
            assert!(is_stopped, "{liar:?} {start} {touch:?}");
            if let Some(touch) = first_touch(&liar, &hovering, end) {
                assert!((start..=end).contains(&touch), "{liar:?} {start} {touch:?}");
            }
        }
    }
}

#[test]
fn pieces_too_short_to_follow_end() {
    for bound in [0.0, 1.0] {
        is_stopped(Liar { digits: 1, bound, ..HONEST });
        is_stopped(Liar { digits: 8, bound, ..HONEST });
    }
}

#[test]
fn bounds_too_large_to_follow_end() {
    for bound in [1e300, f64::MAX, f64::INFINITY, f64::NAN] {
        is_stopped(Liar { bound, ..HONEST });
    }
}

#[test]
fn a_reach_that_is_no_number_is_everywhere() {
    for end in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (reach, bound) in
            [(end, 1.0), (1.0, end), (end, end)].map(|reach| [(reach, 0.0), (reach, 1.0)]).concat()
        {
            let liar = Liar { reach, bound, ..HONEST };
            for approach in approaches(1.0) {
                assert_eq!(first_touch(&liar, &approach, f64::INFINITY), Some(1.0), "{liar:?}");
            }
        }
    }
}

/// A disk must not fly on through a wall that cannot say where it is. The engine finds the NaN when it
/// resolves the touch.
#[test]
fn a_state_that_is_no_number_is_touched_at_once() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for state in [WallState::new(value, 0.0), WallState::new(0.0, value)] {
            for bound in [0.0, 1.0] {
                let liar = Liar { state, bound, ..HONEST };
                for approach in approaches(1.0) {
                    assert_eq!(first_touch(&liar, &approach, 9.0), Some(1.0), "{liar:?}");
                }
                // A disk from above the reach touches when it gets there.
                let falling = Approach::new(0.0, 3.0, 0.0, -1.0);
                assert_eq!(first_touch(&liar, &falling, 9.0), Some(2.0), "{liar:?}");
            }
        }
    }
}

#[test]
fn honest_bounds_of_any_size_change_no_touch() {
    for bound in [1e-300, 1.0, 1e6, 1e9] {
        let falling = Approach::new(0.0, 0.5, 0.0, -1.0);
        let touch = first_touch(&Liar { bound, ..HONEST }, &falling, 9.0).unwrap();
        assert!((touch - 1.0).abs() < 1e-12, "{bound:e}: {touch}");
    }
}
