//! The first descent of a parabola.

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
