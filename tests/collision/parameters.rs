//! Parameters outside their range: each constructor refuses them and names the value.

use granular_edmd::ParameterError;
use granular_edmd::collision::{
    ContactDuration, Elastic, ElasticBelow, Friction, Frictional, LeastRebound, Rough, Smooth, SpeedDependent,
};

/// A constructor of one parameter, that parameter's name, and values that it must refuse beside the usual
/// ones.
type Case = (&'static str, fn(f64) -> Result<(), ParameterError>, &'static [f64]);

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn cases() -> Vec<Case> {
    let normal: &[f64] = &[-1e-300, 0.500_000_1, 1.0, -0.5, 1e300];
    let tangential: &[f64] = &[-1e-300, 1.000_000_1, 2.0, -1e300];
    let restitution: &[f64] = &[-1e-300, 1.000_000_1, -1.0];
    let rough_restitution: &[f64] = &[-1.000_000_1, 1.000_000_1];
    let friction: &[f64] = &[-1e-300, -1.0];
    vec![
        ("normal inelasticity", |value| Smooth::from_inelasticity(value).map(drop), normal),
        ("normal restitution", |value| Smooth::from_restitution(value).map(drop), restitution),
        ("normal inelasticity", |value| Rough::from_inelasticity(value, 0.1).map(drop), normal),
        ("tangential inelasticity", |value| Rough::from_inelasticity(0.1, value).map(drop), tangential),
        ("normal restitution", |value| Rough::from_restitution(value, 0.1).map(drop), restitution),
        ("tangential restitution", |value| Rough::from_restitution(0.1, value).map(drop), rough_restitution),
        ("normal inelasticity", |value| Frictional::from_inelasticity(value, 0.1, 0.2).map(drop), normal),
        (
            "tangential inelasticity",
            |value| Frictional::from_inelasticity(0.1, value, 0.2).map(drop),
            tangential,
        ),
        ("static friction", |value| Frictional::from_inelasticity(0.1, 0.1, value).map(drop), friction),
        ("normal restitution", |value| Frictional::from_restitution(value, 0.1, 0.2).map(drop), restitution),
        (
            "tangential restitution",
            |value| Frictional::from_restitution(0.1, value, 0.2).map(drop),
            rough_restitution,
        ),
        ("static friction", |value| Frictional::from_restitution(0.1, 0.1, value).map(drop), friction),
        (
            "dynamic friction",
            |value| Frictional::from_inelasticity(0.1, 0.2, 0.5)?.with_dynamic_friction(value).map(drop),
            &[-1e-300, 0.500_000_1],
        ),
        ("tangential inelasticity", |value| Friction::from_inelasticity(value, 0.1).map(drop), tangential),
        (
            "tangential restitution",
            |value| Friction::from_restitution(value, 0.1).map(drop),
            rough_restitution,
        ),
        ("static friction", |value| Friction::from_inelasticity(0.1, value).map(drop), friction),
        ("static friction", |value| Friction::from_restitution(0.1, value).map(drop), friction),
        (
            "dynamic friction",
            |value| Friction::from_inelasticity(0.1, 0.5)?.with_dynamic_friction(value).map(drop),
            &[-1e-300, 0.500_000_1],
        ),
        ("contact duration", |value| ContactDuration::new(Elastic, value).map(drop), &[0.0, -0.0, -1e-4]),
        ("speed of elastic collisions", |value| ElasticBelow::new(Elastic, value).map(drop), &[0.0, -1e-4]),
        ("least speed of rebound", |value| LeastRebound::new(Elastic, value).map(drop), &[0.0, -1e-4]),
        ("least restitution", |value| SpeedDependent::from_restitution(value, 1.0).map(drop), restitution),
        ("normal inelasticity", |value| SpeedDependent::from_inelasticity(value, 1.0).map(drop), normal),
        (
            "speed of the least restitution",
            |value| SpeedDependent::from_restitution(0.5, value).map(drop),
            &[0.0, -1.0],
        ),
    ]
}

#[test]
fn each_constructor_refuses_and_names_the_value() {
    for (name, construct, refused) in cases() {
        for value in refused.iter().chain(&NOT_FINITE) {
            let error = construct(*value).expect_err(&format!("{name} {value} was accepted"));
            assert_eq!(error.name(), name);
            assert_eq!(error.value().to_bits(), value.to_bits());
            let text = error.to_string();
            let said =
                text.strip_prefix(&format!("{name} must be {}, but is ", error.requirement())).unwrap();
            assert_eq!(said.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(said.len() < 20, "{text}");
        }
    }
}

#[test]
fn the_ends_of_the_ranges_are_accepted() {
    for value in [0.0, 0.5] {
        assert_eq!(Smooth::from_inelasticity(value).unwrap().normal_inelasticity(), value);
        assert_eq!(Rough::from_inelasticity(value, 0.2).unwrap().normal_inelasticity(), value);
        assert_eq!(Frictional::from_inelasticity(value, value, 0.0).unwrap().normal_inelasticity(), value);
    }
    for value in [0.0, 1.0] {
        assert_eq!(Rough::from_inelasticity(0.5, value).unwrap().tangential_inelasticity(), value);
        assert_eq!(Frictional::from_inelasticity(0.5, value, 0.1).unwrap().tangential_inelasticity(), value);
    }
    assert_eq!(Rough::from_restitution(0.0, -1.0), Rough::from_inelasticity(0.5, 1.0));
    assert_eq!(Frictional::from_restitution(1.0, 1.0, 0.3), Frictional::from_inelasticity(0.0, 0.0, 0.3));
    assert_eq!(Friction::from_restitution(0.5, 0.3), Friction::from_inelasticity(0.25, 0.3));
    assert_eq!(SpeedDependent::from_restitution(0.5, 1.0), SpeedDependent::from_inelasticity(0.25, 1.0));
    let rule = Frictional::from_inelasticity(0.1, 0.2, f64::MAX).unwrap();
    assert_eq!((rule.static_friction(), rule.dynamic_friction()), (f64::MAX, f64::MAX));
    assert!(ContactDuration::new(Elastic, f64::MIN_POSITIVE).is_ok());
}
