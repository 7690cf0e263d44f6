//! First descents of parabolas and quartics: the time at which a gap between two surfaces closes.
//!
//! A custom boundary can find its touches with these functions: write the gap as a polynomial of the time
//! since the flight began, and ask for its first descent. A straight wall gives a parabola
//! ([`first_descent`]). A circle gives a polynomial of degree four ([`first_descent_of_quartic`]): the
//! difference of two squared distances.
//!
//! Both functions follow the stable event detection of Bannerman et al. (2014). Rounding leaves a gap
//! slightly open or slightly closed at each touch. A search that looked at the sign alone would either find
//! the same touch again immediately, or miss the next one and let the surfaces pass through each other.
//! Therefore, a closed gap counts only while it closes.

/// Returns the first time at which the gap `f(t) = value + rate·t + ½·acceleration·t²` is closed and closes
/// further.
///
/// The time $`t \ge 0`$ is counted from the time at which value and rate are given. The result is infinite
/// only if it overflows.
/// - For an open gap, the result is the first zero at which the gap is falling, or `None` if there is no such
///   zero. Rounding decides whether a gap counts if it closes only for an instant and opens again, as at a
///   double root.
/// - A gap that is closed and closes further counts immediately, at time 0.
/// - A gap that is closed but rises counts when it closes next. If it never rises to zero, it counts when it
///   is back at its first value.
///
/// The numbers should be finite. The search uses only `+ - * /` and the square root, so its bits are the same
/// on every platform.
///
/// ```
/// use granular_edmd::roots::first_descent;
/// assert_eq!(first_descent(2.0, 0.0, -1.0), Some(2.0), "it falls from rest");
/// assert_eq!(first_descent(2.0, -1.0, 1.0), None, "it turns before it gets to zero");
/// assert_eq!(first_descent(-1e-16, -1.0, 0.0), Some(0.0), "closed, and closing");
/// assert_eq!(first_descent(-1e-16, 1.0, 0.0), None, "closed, but opening");
/// assert_eq!(first_descent(0.0, 1.0, -1.0), Some(2.0), "it opens, and comes back");
/// ```
#[inline]
pub fn first_descent(value: f64, rate: f64, acceleration: f64) -> Option<f64> {
    // Rounding may leave the gap closed, but opening, after a touch that was just resolved. That touch must
    // not be found again.
    if value <= 0.0 && rate < 0.0 {
        return Some(0.0);
    }
    if acceleration < 0.0 {
        return Some(descent_under_pull(value, rate, acceleration));
    }
    let discriminant = rate * rate - 2.0 * acceleration * value;
    // The first of the two zeros is (-rate - root) / acceleration. For a small acceleration, the numerator is
    // the difference of two nearly equal numbers; without acceleration, the zero is 0 / 0. Multiplication by
    // the conjugate gives a fraction whose denominator is a sum of two positive numbers. This form is also
    // exact for straight flights.
    (rate < 0.0 && discriminant >= 0.0).then(|| 2.0 * value / (discriminant.sqrt() - rate))
}

/// Returns the descent of a parabola that opens downward. There always is one.
#[inline]
fn descent_under_pull(value: f64, rate: f64, acceleration: f64) -> f64 {
    let discriminant = rate * rate - 2.0 * acceleration * value;
    if discriminant <= 0.0 {
        // The gap is still closed at the top of the parabola. A gap that began exactly at zero would close as
        // fast as it opened, at twice the time of the top, so the function returns that time. The time of the
        // top would be wrong: the rate is zero there, so a disk whose bounce is lower than the rounding error
        // would lose its speed, although no rule took it.
        return (-2.0 * rate / acceleration).max(0.0);
    }
    let root = discriminant.sqrt();
    // Each sign of the rate has its own form of the zero. Both forms add numbers of equal sign, so nothing
    // cancels.
    if rate > 0.0 { (rate + root) / -acceleration } else { (2.0 * value / (root - rate)).max(0.0) }
}

/// Coefficients of a polynomial, from the constant term up.
type Coefficients = [f64; 5];

/// Largest coefficient that needs no scaling: multiples of it in the derivatives stay finite.
const LARGEST: f64 = 1e300;

/// Scale of larger coefficients: 2⁻⁶⁰, a power of two, so that scaling is exact.
const SMALLER: f64 = 1.0 / (1u64 << 60) as f64;

/// Returns the first time, not later than `end`, at which the gap `c₀ + c₁t + c₂t² + c₃t³ + c₄t⁴` is closed
/// and closes further.
///
/// The result has the same meaning as for [`first_descent`], which handles polynomials of degree two and
/// less:
/// - An open gap counts at the first zero through which it falls.
/// - A gap that is closed and closes further counts immediately, at time 0.
/// - A closed gap that rises counts when it closes next or, if it falls back to its first value before it
///   opens, at that time.
///
/// The result is `None` if a coefficient is not finite. `end` may be infinite. The search uses only `+ - * /`
/// and, for degree two, the square root, so its bits are the same on every platform.
///
/// ```
/// use granular_edmd::roots::first_descent_of_quartic;
/// // (1 - t)(2 - t)(3 - t)(4 - t): it falls through zero at 1 and 3, and rises through it at 2 and 4.
/// let gap = [24.0, -50.0, 35.0, -10.0, 1.0];
/// let first = first_descent_of_quartic(&gap, f64::INFINITY).unwrap();
/// assert!((first - 1.0).abs() < 1e-15);
/// assert_eq!(first_descent_of_quartic(&gap, 0.5), None);
/// // A disk flies across a circle of radius 2 from its middle, at speed 1: the gap is 4 - t².
/// assert_eq!(first_descent_of_quartic(&[4.0, 0.0, -1.0, 0.0, 0.0], 10.0), Some(2.0));
/// ```
pub fn first_descent_of_quartic(coefficients: &[f64; 5], end: f64) -> Option<f64> {
    let largest = coefficients.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    if !coefficients.iter().all(|c| c.is_finite()) {
        return None;
    }
    let scale = if largest > LARGEST { SMALLER } else { 1.0 };
    let gap = coefficients.map(|c| scale * c);
    if gap[3] == 0.0 && gap[4] == 0.0 {
        return first_descent(gap[0], gap[1], 2.0 * gap[2]).filter(|&time| time <= end);
    }
    if end.is_nan() || end < 0.0 {
        return None;
    }
    if gap[0] <= 0.0 && falls_from_the_start(&gap) {
        return Some(0.0);
    }
    search(&gap, end.min(bound_of_zeros(&gap)))
}

/// Searches the intervals between the turns of the gap, one after the other, for the descent.
fn search(gap: &Coefficients, end: f64) -> Option<f64> {
    let slope = derivative(gap);
    // A gap that begins closed is measured from its first value, so its constant term is exactly zero. A
    // bounce lower than rounding then ends as fast as it began. Once the gap has opened, it is measured from
    // zero.
    let mut measured = *gap;
    measured[0] = measured[0].max(0.0);
    let turns = turns(gap, end);
    turns.stretches().find_map(|(from, to)| {
        if value(gap, from) > 0.0 {
            measured = *gap;
        }
        // The slope has one sign between two turns. The difference of the values at the ends would not show
        // it reliably, since rounding may swallow that difference.
        let falls = value(&slope, middle(from, to)) < 0.0;
        if !falls || value(&measured, to) > 0.0 {
            return None;
        }
        let is_closed = value(&measured, from) <= 0.0;
        Some(if is_closed { from } else { change_of_sign(&measured, from, to) })
    })
}

/// Returns whether the gap falls from the start: the sign of its lowest power decides.
fn falls_from_the_start(gap: &Coefficients) -> bool {
    gap[1..].iter().find(|&&c| c != 0.0).is_some_and(|&c| c < 0.0)
}

/// Returns a time beyond all zeros of a polynomial and of its derivatives. The bound is Cauchy's; by the
/// theorem of Gauss and Lucas, it also holds for the zeros of the derivatives.
fn bound_of_zeros(polynomial: &Coefficients) -> f64 {
    let leading = polynomial.iter().rposition(|&c| c != 0.0).unwrap_or(0);
    let largest = polynomial[..leading].iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    // A tiny leading coefficient can put a zero beyond the largest number, so the bound is cut to a finite
    // one. There, the sums of Horner's scheme may overflow, but an infinite sum that is multiplied by a
    // finite positive time and increased by a finite coefficient keeps its sign.
    (1.0 + largest / polynomial[leading].abs()).min(f64::MAX)
}

/// Evaluates a polynomial by Horner's scheme.
fn value(polynomial: &Coefficients, time: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * time + c)
}

fn derivative(&[_, c1, c2, c3, c4]: &Coefficients) -> Coefficients {
    [c1, 2.0 * c2, 3.0 * c3, 4.0 * c4, 0.0]
}

fn middle(low: f64, high: f64) -> f64 {
    // The code does not halve the sum, because the sum may overflow.
    low + 0.5 * (high - low)
}

/// At most five times, in ascending order. At each of them except the first and the last, a polynomial
/// changes its sign.
#[derive(Clone, Copy)]
struct Marks {
    times: [f64; 5],
    count: usize,
}

impl Marks {
    fn push(&mut self, time: f64) {
        self.times[self.count] = time;
        self.count += 1;
    }

    /// Returns the intervals of time between neighboring marks.
    fn stretches(&self) -> impl Iterator<Item = (f64, f64)> {
        self.times[..self.count].windows(2).map(|pair| (pair[0], pair[1]))
    }

    /// Returns the times at which a polynomial changes its sign. `self` holds the times at which its
    /// derivative changes its sign.
    ///
    /// Between two marks the polynomial is monotonic, so it changes its sign at most once. No change can be
    /// missed, however close two of them are.
    fn refined(&self, polynomial: &Coefficients) -> Self {
        let (start, end) = (self.times[0], self.times[self.count - 1]);
        let mut marks = Self { times: [start; 5], count: 1 };
        for (from, to) in self.stretches() {
            if (value(polynomial, from) > 0.0) != (value(polynomial, to) > 0.0) {
                marks.push(change_of_sign(polynomial, from, to));
            }
        }
        marks.push(end);
        marks
    }
}

/// Returns the times between 0 and `end` at which the polynomial turns. These are the zeros of its slope,
/// found from the zeros of the slope's derivatives.
fn turns(polynomial: &Coefficients, end: f64) -> Marks {
    let first = derivative(polynomial);
    let second = derivative(&first);
    let third = derivative(&second);
    let ends = Marks { times: [0.0, end, end, end, end], count: 2 };
    ends.refined(&third).refined(&second).refined(&first)
}

/// Returns the first number beyond a change of sign between `low` and `high`.
///
/// The search halves the interval, and each step decides one bit. Newton's method would need fewer steps, but
/// at a double zero, the slope is only a rounding error, and the next step would leave the interval. The
/// function returns the far side of the change, so that a search that ends at this time finds the change
/// again.
fn change_of_sign(polynomial: &Coefficients, mut low: f64, mut high: f64) -> f64 {
    let positive = value(polynomial, low) > 0.0;
    loop {
        let middle = middle(low, high);
        if middle <= low || middle >= high {
            return high;
        }
        if (value(polynomial, middle) > 0.0) == positive {
            low = middle;
        } else {
            high = middle;
        }
    }
}
