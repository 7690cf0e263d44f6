//! First descents of parabolas and quartics, which steps along the gap, known zeros and flights confirm.

use approx::assert_abs_diff_eq;
use granular_edmd::glam::DVec2;
use granular_edmd::roots::{first_descent, first_descent_of_quartic};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use oracles::check_quartic;
use support::cases::{config, few};

#[test]
fn closed_parabolas_count_only_while_they_close() {
    assert_eq!(first_descent(-1e-16, -1.0, 0.0), Some(0.0));
    assert_eq!(first_descent(-1e-16, 1.0, 0.0), None);
    assert_eq!(first_descent(0.0, 0.0, 1.0), None);
    assert_eq!(first_descent(0.0, 0.0, -1.0), Some(0.0));
    assert_eq!(first_descent(0.0, 1.0, -1.0), Some(2.0));
    assert_eq!(first_descent(-1.0, 1.0, -1.0), Some(2.0), "it never opens: it counts when it is back");
    assert_eq!(first_descent(-1.0, 1.0, -2.0), Some(1.0), "and that is sooner the stronger the pull");
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn the_root_of_a_parabola_is_the_first(
        value in 0.0..100.0f64, rate in -10.0..10.0f64, acceleration in -5.0..5.0f64,
    ) {
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

/// Returns `scale` times the product of `(t - zero)`, and of `(t - zero)² + width²` for each pair of zeros
/// that are not real.
fn product(scale: f64, zeros: &[f64], pairs: &[(f64, f64)]) -> [f64; 5] {
    let mut coefficients = [scale, 0.0, 0.0, 0.0, 0.0];
    let mut multiply = |factor: [f64; 3]| {
        let old = coefficients;
        for (k, c) in coefficients.iter_mut().enumerate() {
            *c = (0..=k.min(2)).map(|j| factor[j] * old[k - j]).sum();
        }
    };
    for &zero in zeros {
        multiply([-zero, 1.0, 0.0]);
    }
    for &(middle, width) in pairs {
        multiply([middle * middle + width * width, -2.0 * middle, 1.0]);
    }
    coefficients
}

fn between(generator: &mut Xoshiro256PlusPlus, low: f64, high: f64) -> f64 {
    generator.random_range(low..high)
}

#[test]
fn polynomials_of_any_coefficients_descend_where_steps_along_them_find_it() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut found = 0;
    for _ in 0..6000 {
        let spread = between(&mut generator, 0.1, 3.0);
        let coefficients: [f64; 5] = std::array::from_fn(|_| {
            let x = between(&mut generator, -1.0, 1.0);
            spread * x * x * x
        });
        found += usize::from(check_quartic(&coefficients, between(&mut generator, 0.5, 6.0)).is_some());
    }
    assert!((2000..5500).contains(&found), "{found}");
}

#[test]
fn known_zeros_are_found_in_order() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(2);
    for case in 0..6000 {
        let mut zeros: Vec<f64> =
            (0..=generator.random_range(0..4_u32)).map(|_| between(&mut generator, -1.0, 5.0)).collect();
        zeros.sort_by(f64::total_cmp);
        if zeros.windows(2).any(|pair| pair[1] - pair[0] < 1e-3) || zeros.iter().any(|zero| zero.abs() < 1e-3)
        {
            continue;
        }
        let pairs = if zeros.len() < 3 { vec![(between(&mut generator, 0.0, 5.0), 0.3)] } else { Vec::new() };
        for scale in [1.0, -1.0, 1e-200, -1e200] {
            let coefficients = product(scale, &zeros, &pairs);
            // The gap falls through every other zero. Beyond the last zero it has the sign of the scale.
            let falling = (0..zeros.len()).filter(|k| (zeros.len() - k).is_multiple_of(2) == (scale > 0.0));
            let expected = falling.map(|k| zeros[k]).find(|&zero| zero > 0.0);
            let is_closing = coefficients[0] <= 0.0 && coefficients[1] < 0.0;
            let found = first_descent_of_quartic(&coefficients, f64::INFINITY);
            if is_closing {
                assert_eq!(found, Some(0.0), "{case} {zeros:?}");
            } else if coefficients[0] > 0.0 {
                let (found, expected) = (found.unwrap_or(-1.0), expected.unwrap_or(-1.0));
                assert!((found - expected).abs() < 1e-7, "{case} {scale} {zeros:?}: {found}, not {expected}");
            }
            check_quartic(&coefficients, 7.0);
        }
    }
}

/// Disks fly inside a circle and are pulled down. The gap that remains at the touch is no more than rounding.
#[test]
fn flights_in_a_circle_end_at_its_wall() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut draw =
        |size: f64| DVec2::new(between(&mut generator, -size, size), between(&mut generator, -size, size));
    for case in 0..5000 {
        let (r, v, a) = (draw(0.7), draw(3.0), DVec2::new(0.0, draw(1.0).x));
        let gap = [
            1.0 - r.length_squared(),
            -2.0 * r.dot(v),
            -(v.length_squared() + r.dot(a)),
            -v.dot(a),
            -0.25 * a.length_squared(),
        ];
        let time = check_quartic(&gap, 1e3).unwrap();
        let place = r + (v + 0.5 * time * a) * time;
        assert!((place.length() - 1.0).abs() < 1e-13, "{case}: {}", place.length());
        // A search that ends at the descent still finds it, up to the rounding of the gap.
        let again = first_descent_of_quartic(&gap, time).unwrap();
        assert!(again <= time && time - again < 1e-13 * (1.0 + time), "{case}: {time} {again}");
        assert_eq!(first_descent_of_quartic(&gap, time * (1.0 - 1e-9)), None);
    }
}

#[test]
fn closed_quartics_count_only_while_they_close() {
    let descent = |c: [f64; 5]| first_descent_of_quartic(&c, f64::INFINITY);
    assert_eq!(descent([-1e-16, -1.0, 0.0, 0.0, 1.0]), Some(0.0));
    assert_eq!(descent([0.0, 0.0, 0.0, 0.0, -1.0]), Some(0.0));
    assert_eq!(descent([0.0, 0.0, 0.0, 1.0, 1.0]), None);
    assert_eq!(descent([0.0, 0.0, 0.0, 0.0, 0.0]), None);
    assert_eq!(descent([0.0, 1.0, 0.0, -1.0, 0.0]), Some(1.0));
    // The gap is still closed at its top. It counts when it is back at its first value, not at the top.
    let (low, exact) = (descent([-1.0, 1.0, 0.0, -1.0, 0.0]).unwrap(), 1.0);
    assert!((low - exact).abs() < 1e-15, "{low}");
    // A little higher, and the gap opens.
    assert_abs_diff_eq!(descent([-0.3, 1.0, 0.0, -1.0, 0.0]).unwrap(), 0.786_4, epsilon = 1e-4);
}

#[test]
fn hostile_numbers_end() {
    let hostile = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-300,
        -1e-300,
        5e-324,
        1e300,
        -1e300,
        f64::MAX,
        f64::MIN,
        f64::INFINITY,
        f64::NAN,
    ];
    for [a, b] in few(hostile.map(|a| hostile.map(|b| [a, b])).concat(), 4) {
        for [c, d] in hostile.map(|c| hostile.map(|d| [c, d])).concat() {
            for e in hostile {
                for end in [0.0, 1.0, 1e300, f64::INFINITY, f64::NAN, -1.0] {
                    if let Some(time) = first_descent_of_quartic(&[a, b, c, d, e], end) {
                        assert!((0.0..=end).contains(&time), "{:?} {end}: {time}", [a, b, c, d, e]);
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(256))]

    /// The quartic is of degree two in disguise: a tiny quartic term must not move the descent of a parabola.
    #[test]
    fn tiny_terms_do_not_matter(value in -1.0..10.0f64, rate in -3.0..3.0f64, acceleration in -3.0..-0.1f64) {
        let plain = first_descent(value, rate, acceleration).unwrap();
        let disguised = first_descent_of_quartic(&[value, rate, 0.5 * acceleration, 0.0, -1e-250], 1e3).unwrap();
        prop_assume!(rate * rate - 2.0 * acceleration * value != 0.0);
        let turn = (rate * rate - 2.0 * acceleration * value).abs().sqrt();
        prop_assert!((plain - disguised).abs() < 1e-13 * (1.0 + 1.0 / turn), "{plain} {disguised}");
    }
}
