//! A user's rule under the checks of the library.

use downstream::viscoelastic::Viscoelastic;
use granular_edmd::collision::{collide, laws};
use granular_edmd::strategies;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// The same cases on every run and machine.
fn config() -> ProptestConfig {
    ProptestConfig { rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn every_rule_is_lawful(loss in 0.0..10.0, friction in 0.0..2.0) {
        let rule = Viscoelastic::new(loss, friction).unwrap();
        prop_assert_eq!(laws::check(&rule, &laws::Promises::new().with_friction(friction)), Ok(()));
    }

    #[test]
    fn energy_goes_where_the_impulse_says((first, second) in strategies::touching_pair(), loss in 0.0..10.0) {
        let after = collide(&Viscoelastic::new(loss, 0.3).unwrap(), &first, &second);
        let energy = |disk: &granular_edmd::Disk| disk.translational_energy() + disk.rotational_energy();
        let (before, now) = (energy(&first) + energy(&second), energy(&after.first) + energy(&after.second));
        let change = after.impulse.energy_change(&after.contact);
        prop_assert!((now - before - change).abs() <= 1e-14 * (now + before));
    }
}

#[test]
fn parameters_out_of_range_are_named() {
    let error = Viscoelastic::new(f64::NAN, 0.0).unwrap_err();
    assert_eq!(error.to_string(), "loss must be finite and not negative, but is NaN");
    assert_eq!(Viscoelastic::new(0.0, -1.0).unwrap_err().name(), "static friction");
}
