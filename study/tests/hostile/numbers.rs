//! Plans and analysis over every kind of number, and over none, one or two of everything.

use granular_edmd::observable::ConvectionOrder;
use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria, thermal_noise, transitions};
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Plan, Protocol};

/// Numbers that a file or a typing error may bring.
const NUMBERS: [f64; 18] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MIN,
    -1e300,
    -1.0,
    -1e-9,
    -5e-324,
    -0.0,
    0.0,
    5e-324,
    1e-320,
    1e-30,
    0.3,
    1.0,
    1e30,
    1e300,
    f64::MAX,
];

#[test]
fn analysis_of_none_one_or_two_is_an_answer_or_an_error() {
    let points = [0.0, 1.0];
    for count in 0..=2 {
        let samples: Vec<f64> = points[..count].to_vec();
        let order: Vec<_> = samples.iter().map(|&x| ConvectionOrder::new(x, x)).collect();
        assert_eq!(StateCriteria::default().classify(&order, 0.1, None).is_ok(), count > 0);
        let seen = samples.iter().map(|&x| (x, ConvectiveRegime::OneRoll));
        assert!(transitions(seen).unwrap().is_empty());
    }
    assert!(thermal_noise(1.0, 1.0, 0).is_err());
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(transitions([(bad, ConvectiveRegime::OneRoll)]).is_err());
        assert!(StateCriteria::default().classify(&[ConvectionOrder::new(bad, bad)], 0.1, None).is_err());
    }
}

/// A constructor of one number, by the name that its error must have, and the numbers that it takes.
type Case = (&'static str, fn(f64) -> Result<(), String>, fn(f64) -> bool);

fn told<T>(result: Result<T, impl ToString>) -> Result<(), String> {
    result.map(drop).map_err(|error| error.to_string())
}

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

fn analysis() -> Vec<Case> {
    vec![
        ("", |value| told(thermal_noise(value, 1.0, 10)), not_negative),
        (
            "noise",
            |value| told(StateCriteria::default().classify(&[ConvectionOrder::new(0.0, 0.0)], value, None)),
            not_negative,
        ),
        (
            "multiple of the noise",
            |value| told(StateCriteria::default().with_noise_multiple(value)),
            not_negative,
        ),
        ("ratio of two rolls", |value| told(StateCriteria::default().with_two_rolls(value)), positive),
        ("packing fraction", |value| told(StateCriteria::default().with_collapse(value, 0.1)), not_negative),
    ]
}

#[test]
fn each_number_is_taken_or_named() {
    for (name, construct, takes) in analysis() {
        for value in NUMBERS {
            match construct(value) {
                Ok(()) => assert!(takes(value), "{name} {value:e} was taken"),
                Err(error) => {
                    assert!(!takes(value), "{value:e} was refused: {error}");
                    let said = error.rsplit(' ').next().unwrap().parse::<f64>();
                    let is_named = said.is_ok_and(|said| said == value || said.is_nan() && value.is_nan());
                    assert!(error.starts_with(name) && is_named, "{value}: {error}");
                }
            }
        }
    }
}

/// Whatever a plan varies is taken or refused at once, and its text is read as what it is.
#[test]
fn plans_of_any_numbers_are_taken_or_refused() {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 3.0 };
    let names =
        ["friction", "dynamic_friction", "inelasticity", "tangential_inelasticity", "gravity", "amplitude"];
    let more = ["angular_frequency", "temperature", "contact_duration", "width", "height"];
    for (name, value) in names.into_iter().chain(more).flat_map(|name| NUMBERS.map(|value| (name, value))) {
        let plan = Plan::new(VibratedBox::new(2, 9.0, base), Protocol::new(1, 1, 1).unwrap(), 1).unwrap();
        let Ok(plan) = Axis::new(name, [value]).and_then(|axis| plan.with_axis(axis)) else { continue };
        assert_eq!(Plan::from_toml(&plan.to_toml().unwrap()).unwrap(), plan, "{name} {value}");
    }
    for [settle, samples, every] in
        [[0, 0, 0], [1, 1, 0], [0, 1, 1], [u64::MAX; 3], [1, u64::MAX, 1], [0, 1, u64::MAX]]
    {
        let protocol = Protocol::new(settle, samples, every);
        assert_eq!(protocol.is_ok(), (settle, samples, every) == (0, 1, 1), "{protocol:?}");
    }
}
