//! Radii from distributions.

use granular_edmd::initial::{self, Radii};

const COUNT: usize = 100_000;

/// Returns the share of radii below this one.
fn share_below(radii: &[f64], bound: f64) -> f64 {
    radii.iter().filter(|&&radius| radius < bound).count() as f64 / radii.len() as f64
}

/// The share of radii below a bound has a standard error of 0.0016 at most; five of them are allowed.
#[test]
fn shares_are_those_of_the_distributions() {
    let normal = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    let cut = |r: f64| normal(libm::log(r / 0.5) / 0.4);
    let power = |r: f64, a: f64| 1.0 - libm::pow(r, 1.0 - a);
    let cases = [
        (Radii::uniform(0.5, 1.5).unwrap(), 0.75, 0.25),
        (Radii::log_normal(0.5, 0.4, 0.3, 2.0).unwrap(), 0.5, (0.5 - cut(0.3)) / (cut(2.0) - cut(0.3))),
        (Radii::log_normal(0.5, 0.4, 0.3, 2.0).unwrap(), 0.8, (cut(0.8) - cut(0.3)) / (cut(2.0) - cut(0.3))),
        (Radii::log_normal(1.0, 0.01, 0.1, 1e3).unwrap(), 1.0, 0.5),
        (Radii::log_normal(1.0, 1e6, 0.5, 2.0).unwrap(), 1.0, 0.5),
        (Radii::power_law(3.0, 1.0, 100.0).unwrap(), 2.0, power(2.0, 3.0) / power(100.0, 3.0)),
        (Radii::power_law(2.5, 1.0, 10.0).unwrap(), 3.0, power(3.0, 2.5) / power(10.0, 2.5)),
        (Radii::power_law(1.0, 1.0, 100.0).unwrap(), 10.0, 0.5),
        (Radii::power_law(0.0, 1.0, 3.0).unwrap(), 2.0, 0.5),
        (Radii::two_sizes(0.5, 0.7, 0.3).unwrap(), 0.6, 0.7),
    ];
    for (radii, bound, expected) in cases {
        let share = share_below(&radii.draw(COUNT, 5), bound);
        assert!((share - expected).abs() < 0.008, "{radii:?}: {share} below {bound}, not {expected}");
    }
}

#[test]
fn bounds_are_kept_and_seeds_decide() {
    for radii in [
        Radii::uniform(0.5, 0.500_000_1).unwrap(),
        Radii::uniform(0.5, 0.5).unwrap(),
        Radii::log_normal(0.5, 3.0, 0.4, 0.6).unwrap(),
        Radii::log_normal(0.4, 0.1, 0.4, 0.4).unwrap(),
        Radii::power_law(10.0, 1e-30, 1e30).unwrap(),
        Radii::power_law(0.999_999_999, 0.1, 10.0).unwrap(),
    ] {
        let drawn = radii.draw(2000, 9);
        let (least, most) = drawn.iter().fold((f64::INFINITY, 0.0), |(a, b), &r| (r.min(a), r.max(b)));
        assert!(initial::disks_from_radii(drawn.clone(), 1e-20).is_ok() || most < 1e-4, "{radii:?}");
        assert!(least > 0.0 && most.is_finite() && least <= most, "{radii:?}: {least} to {most}");
        assert_eq!(drawn, radii.draw(2000, 9));
    }
    let radii = Radii::uniform(0.4, 0.6).unwrap();
    assert_ne!(radii.draw(10, 1), radii.draw(10, 2));
    assert!(radii.draw(1000, 1).iter().all(|radius| (0.4..=0.6).contains(radius)));
}

/// A change of these bits changes initial states. It must be announced under "Results" in the changelog.
#[test]
fn draws_keep_their_bits() {
    let drawn = [
        Radii::uniform(0.4, 0.6).unwrap(),
        Radii::log_normal(0.5, 0.3, 0.2, 1.2).unwrap(),
        Radii::power_law(2.5, 0.3, 3.0).unwrap(),
    ]
    .map(|radii| radii.draw(1, 1)[0].to_bits());
    assert_eq!(drawn, GOLDEN, "{drawn:?}");
}

const GOLDEN: [u64; 3] = [4_601_348_595_826_434_874, 4_597_331_097_876_168_205, 4_599_586_552_256_091_194];

/// Half means half, not half on average.
#[test]
fn two_sizes_are_counted() {
    let radii = Radii::two_sizes(0.5, 0.7, 0.5).unwrap().draw(1001, 3);
    assert_eq!(radii.iter().filter(|&&radius| radius == 0.7).count(), 501);
    let [none, all] = [0.0, 1.0].map(|share| Radii::two_sizes(0.5, 0.7, share).unwrap().draw(9, 3));
    assert!(none.iter().all(|&radius| radius == 0.5) && all.iter().all(|&radius| radius == 0.7));
}

#[test]
fn parameters_are_checked() {
    let refused = [
        (Radii::uniform(0.0, 1.0), "smallest radius must be finite and positive, but is 0"),
        (Radii::uniform(1.0, f64::INFINITY), "largest radius must be finite and positive, but is inf"),
        (Radii::uniform(1.0, 0.5), "largest radius must be no less than the smallest, but is 0.5"),
        (
            Radii::log_normal(2.0, 0.1, 0.5, 1.0),
            "median radius must be between the smallest and the largest, but is 2",
        ),
        (
            Radii::log_normal(0.7, 0.0, 0.5, 1.0),
            "deviation of log-normal radii must be finite and positive, but is 0",
        ),
        (Radii::power_law(11.0, 0.5, 1.0), "exponent of radii must be in [0, 10], but is 11"),
        (Radii::two_sizes(0.5, 1.0, 1.5), "share of large disks must be in [0, 1], but is 1.5"),
        (Radii::two_sizes(0.5, f64::NAN, 0.5), "largest radius must be finite and positive, but is NaN"),
    ];
    for (radii, message) in refused {
        assert_eq!(radii.unwrap_err().to_string(), message);
    }
}
