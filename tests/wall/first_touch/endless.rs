//! Motions that no search could follow. The search ends all the same, and lets nothing through.

use granular_edmd::wall::{AccelerationBounds, Approach, FirstTouch, WallMotion, WallState, first_touch};

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

/// Checks that the search ends, invents no touch, and does not let the surface that sinks past the wall
/// unnoticed.
fn is_stopped(liar: Liar) {
    for start in [0.0, 1.0, 1e9, -3.0] {
        let [hovering, sinking] = approaches(start);
        for end in [start + 100.0, f64::INFINITY] {
            let touch = start + 5.0;
            match first_touch(&liar, &sinking, end) {
                FirstTouch::At(time) => assert!((time - touch).abs() < 1e-5, "{liar:?} {start} {time}"),
                FirstTouch::NotBefore(time) => {
                    assert!((start..=touch).contains(&time), "{liar:?} {start} {time}");
                }
            }
            assert_eq!(first_touch(&liar, &hovering, end).touch(), None, "{liar:?} {start}");
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
fn a_reach_that_is_no_number_stops_the_search() {
    for end in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (reach, bound) in
            [(end, 1.0), (1.0, end), (end, end)].map(|reach| [(reach, 0.0), (reach, 1.0)]).concat()
        {
            let liar = Liar { reach, bound, ..HONEST };
            for approach in approaches(1.0) {
                let answer = first_touch(&liar, &approach, f64::INFINITY);
                assert_eq!(answer, FirstTouch::NotBefore(1.0), "{liar:?}");
            }
        }
    }
}

/// A disk must not fly on through a wall that cannot say where it is. The search gets no further, and a run
/// ends with an error.
#[test]
fn a_state_that_is_no_number_stops_the_search() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for state in [WallState::new(value, 0.0), WallState::new(0.0, value)] {
            for bound in [0.0, 1.0] {
                let liar = Liar { state, bound, ..HONEST };
                for approach in approaches(1.0) {
                    let answer = first_touch(&liar, &approach, 9.0);
                    assert_eq!(answer, FirstTouch::NotBefore(1.0), "{liar:?}");
                }
                // A disk from above the reach flies up to it.
                let falling = Approach::new(0.0, 3.0, 0.0, -1.0);
                assert_eq!(first_touch(&liar, &falling, 9.0), FirstTouch::NotBefore(2.0), "{liar:?}");
            }
        }
    }
}

#[test]
fn honest_bounds_of_any_size_change_no_touch() {
    for bound in [1e-300, 1.0, 1e6, 1e9] {
        let (liar, mut open) = (Liar { bound, ..HONEST }, 0.0);
        // Under large bounds, the way to the touch takes several searches.
        let touch = loop {
            let falling = Approach::new(open, 0.5 - 0.5 * open * open, -open, -1.0);
            match first_touch(&liar, &falling, 9.0) {
                FirstTouch::At(touch) => break touch,
                FirstTouch::NotBefore(time) => {
                    assert!(time > open && time < 1.0 + 1e-12, "{bound:e}: {time}");
                    open = time;
                }
            }
        };
        assert!((touch - 1.0).abs() < 1e-12, "{bound:e}: {touch}");
    }
}
