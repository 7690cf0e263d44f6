//! The boundary between sticking and sliding.

use granular_edmd::collision::{CollisionRule, Contact, Frictional, Regime, laws};
use granular_edmd::strategies::decades;
use proptest::prelude::*;

use crate::rules::config;

/// A step far above rounding and far below anything else.
const STEP: f64 = 1e-9;

fn rule(normal: f64, tangential: f64, static_friction: f64, dynamic_friction: f64) -> Frictional {
    Frictional::from_inelasticity(normal, tangential, static_friction)
        .and_then(|rule| rule.with_dynamic_friction(dynamic_friction))
        .unwrap()
}

/// Contacts of closing speed 1 just within and just beyond the hold of static friction.
fn both_sides(rule: &Frictional, mass: f64, share: f64) -> (Contact, Contact) {
    let limit = (1.0 - rule.normal_inelasticity()) * rule.static_friction()
        / ((1.0 - rule.tangential_inelasticity()) * share);
    let at = |slip: f64| Contact::new(1.0, slip, mass, mass * share);
    (at(limit * (1.0 - STEP)), at(limit * (1.0 + STEP)))
}

proptest! {
    #![proptest_config(config())]

    /// The impulse and the loss are continuous under one friction coefficient. A step of `STEP` in the slip
    /// changes them by a few `STEP` of their size.
    #[test]
    fn one_coefficient_joins_the_branches(
        normal in 0.0..=0.5,
        tangential in 0.0..=0.99,
        friction in decades(-3.0, 3.0),
        mass in decades(-6.0, 6.0),
        share in decades(-3.0, 0.0),
    ) {
        let rule = rule(normal, tangential, friction, friction);
        let (within, beyond) = both_sides(&rule, mass, share);
        let (stick, slide) = (rule.impulse(&within), rule.impulse(&beyond));
        prop_assert_eq!((stick.regime(), slide.regime()), (Regime::Sticking, Regime::Sliding));
        prop_assert!((stick.tangential() / slide.tangential() - 1.0).abs() <= 2.0 * STEP);
        let jump = stick.energy_change(&within) - slide.energy_change(&beyond);
        prop_assert!(jump.abs() <= 8.0 * STEP * within.available_energy(), "{jump}");
    }

    /// The impulse drops by the ratio of the coefficients if dynamic friction is less than static friction.
    /// Neither side gains energy.
    #[test]
    fn two_coefficients_drop(
        normal in 0.0..=0.5,
        tangential in 0.0..=0.99,
        friction in decades(-3.0, 3.0),
        ratio in 0.0..1.0_f64,
        share in decades(-3.0, 0.0),
    ) {
        let rule = rule(normal, tangential, friction, ratio * friction);
        let (within, beyond) = both_sides(&rule, 1.0, share);
        let (stick, slide) = (rule.impulse(&within), rule.impulse(&beyond));
        prop_assert!((slide.tangential() - ratio * stick.tangential()).abs() <= 2.0 * STEP * stick.tangential());
        prop_assert_eq!(laws::check_impulse(&within, stick), Ok(()));
        prop_assert_eq!(laws::check_impulse(&beyond, slide), Ok(()));
    }
}

/// Homogeneous disks stick below $`3(1-q_n)\kappa_s v_n/(1-q_t)`$, the paper's number.
#[test]
fn the_threshold_of_homogeneous_disks() {
    let rule = rule(0.1, 0.2, 0.5, 0.4);
    let regime = |slip| rule.impulse(&Contact::new(1.0, slip, 0.5, 0.5 / 3.0)).regime();
    let limit = 3.0 * 0.9 * 0.5 / 0.8;
    assert_eq!(regime(limit - STEP), Regime::Sticking);
    assert_eq!(regime(limit + STEP), Regime::Sliding);
    assert_eq!(regime(STEP - limit), Regime::Sticking);
    assert_eq!(regime(-STEP - limit), Regime::Sliding);
}

/// The loss would jump by $`6\kappa^2 q_t(1-q_n)^2/(1-q_t)`$ at the boundary, if Eq. (6) were right as
/// printed, without the factor 1/3. This is one of the reasons to read it as a misprint.
#[test]
fn the_printed_loss_would_jump() {
    let (normal, tangential, friction) = (0.1, 0.2, 0.5);
    let rule = rule(normal, tangential, friction, friction);
    let (within, beyond) = both_sides(&rule, 0.5, 1.0 / 3.0);
    let slip = within.slip_speed();
    let printed = -normal * (1.0 - normal) - tangential * (1.0 - tangential) * slip * slip;
    let jump = rule.impulse(&beyond).energy_change(&beyond) - printed;
    let expected = 6.0 * (friction * (1.0 - normal)).powi(2) * tangential / (1.0 - tangential);
    assert!((jump - expected).abs() < 1e-7, "{jump} != {expected}");
}

/// The paper's estimate below Fig. 2: sliding loses most at $`\kappa_d = |v_t|/[6 v_n(1-q_n)]`$.
#[test]
fn the_friction_that_loses_most() {
    let (normal, closing, slip) = (0.1, 1.5, 4.0);
    let best = slip / (6.0 * closing * (1.0 - normal));
    let loss = |friction: f64| {
        let contact = Contact::new(closing, slip, 0.5, 0.5 / 3.0);
        let impulse = rule(normal, 0.0, friction, friction).impulse(&contact);
        assert_eq!(impulse.regime(), Regime::Sliding);
        -impulse.energy_change(&contact)
    };
    assert!(loss(best) > loss(best * 1.01) && loss(best) > loss(best * 0.99));
}
