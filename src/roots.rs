//! Roots of the parabolas that decide when surfaces meet.

/// The first time `$t\ge 0$` at which `$f(t) = f_0 + f_1 t + \tfrac12 f_2 t^2$` is not positive and falls.
///
/// Stable event detection (Bannerman et al. 2014): a gap that is closed by rounding counts at once while it closes,
/// never while it opens; a gap that does not open again counts when it closes as fast as it opened, as if it had been
/// closed exactly: a disk that bounces lower than rounding still bounces. Both roots are written so that nothing cancels.
#[inline]
pub(crate) fn first_descent(value: f64, rate: f64, acceleration: f64) -> Option<f64> {
    if value <= 0.0 && rate < 0.0 {
        return Some(0.0);
    }
    if acceleration < 0.0 {
        return Some(descent_under_pull(value, rate, acceleration));
    }
    let discriminant = rate * rate - 2.0 * acceleration * value;
    (rate < 0.0 && discriminant >= 0.0).then(|| 2.0 * value / (discriminant.sqrt() - rate))
}

/// The descent of a parabola that opens downward: there always is one.
#[inline]
fn descent_under_pull(value: f64, rate: f64, acceleration: f64) -> f64 {
    let discriminant = rate * rate - 2.0 * acceleration * value;
    if discriminant <= 0.0 {
        return (-2.0 * rate / acceleration).max(0.0);
    }
    let root = discriminant.sqrt();
    if rate > 0.0 { (rate + root) / -acceleration } else { (2.0 * value / (root - rate)).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::first_descent;
    use proptest::prelude::*;

    #[test]
    fn closed_gaps_count_only_while_they_close() {
        assert_eq!(first_descent(-1e-16, -1.0, 0.0), Some(0.0));
        assert_eq!(first_descent(-1e-16, 1.0, 0.0), None);
        assert_eq!(first_descent(0.0, 0.0, 1.0), None);
        assert_eq!(first_descent(0.0, 0.0, -1.0), Some(0.0));
        assert_eq!(first_descent(0.0, 1.0, -1.0), Some(2.0));
        assert_eq!(first_descent(-1.0, 1.0, -1.0), Some(2.0), "it never opens: it counts when it is back");
        assert_eq!(first_descent(-1.0, 1.0, -2.0), Some(1.0), "and that is sooner the stronger the pull");
    }

    proptest! {
        #[test]
        fn the_root_is_the_first(value in 0.0..100.0f64, rate in -10.0..10.0f64, acceleration in -5.0..5.0f64) {
            let f = |t: f64| value + rate * t + 0.5 * acceleration * t * t;
            let end = first_descent(value, rate, acceleration).unwrap_or(1e3);
            for k in 0..1000 {
                let t = end * f64::from(k) / 1000.0;
                prop_assert!(f(t) >= -1e-9 * (value + rate.abs() * t + acceleration.abs() * t * t));
            }
            if let Some(t) = first_descent(value, rate, acceleration) {
                prop_assert!(f(t).abs() <= 1e-12 * (value + rate.abs() * t + acceleration.abs() * t * t));
                prop_assert!(rate + acceleration * t <= 1e-6);
            }
        }
    }
}
