//! Every kind of value that a study reads from files, with one field too many. Each is refused by name.

use granular_edmd_study::analysis::Transition;
use granular_edmd_study::vibrated_box::{Base, Measurement, Sample, VibratedBox};
use granular_edmd_study::{Axis, Course, Outcome, Plan, Protocol, Ramp};
use serde_json::json;

use crate::intruders::refuses;
use crate::studies::{done_study, plan};

#[test]
fn plans_and_records_with_a_field_too_many_are_refused() {
    refuses(&plan());
    refuses(&Ramp::new("friction", [0.1], Course::Down).unwrap());
    refuses(&Axis::new("friction", [0.1]).unwrap());
    for base in [
        Base::BiParabolic { amplitude: 0.1, angular_frequency: 1.0 },
        Base::Sinusoidal { amplitude: 0.1, angular_frequency: 1.0 },
        Base::Thermal { temperature: 1.0, slip: true },
    ] {
        let experiment = VibratedBox::new(3, 4.0, base).with_height(3.0).with_contact_duration(1e-3);
        refuses(&Plan::new(experiment, Protocol::new(2, 3, 1).unwrap(), 5).unwrap());
    }
    let (_scratch, study) = done_study("intruder", &plan());
    let record = study.record(0, 1).unwrap().unwrap();
    refuses::<Sample>(&record.samples()[0]);
    let mut measurement = serde_json::to_value(record.observer()).unwrap();
    measurement["intruder"] = json!(1);
    assert!(serde_json::from_value::<Measurement>(measurement).unwrap_err().to_string().contains("intruder"));
    let transition = json!({ "line": "ZeroOne", "value": 0.1, "error": 0.01, "rising": true });
    refuses(&serde_json::from_value::<Transition>(transition).unwrap());
    refuses(&Outcome::Stopped { time: 1.0 });
}

/// The same holds in TOML, at each place of a plan.
#[test]
fn a_plan_in_toml_with_a_field_too_many_is_refused() {
    let text = plan().to_toml().unwrap();
    let lines: Vec<&str> = text.lines().collect();
    for at in 0..=lines.len() {
        let changed = [&lines[..at], &["intruder = 1"], &lines[at..]].concat().join("\n");
        let error = Plan::<VibratedBox>::from_toml(&changed).unwrap_err().to_string();
        assert!(error.contains("intruder"), "{error}");
    }
}

/// Deeply nested values are refused at once, and so is a plan that is too large.
#[test]
fn plans_that_are_too_deep_or_too_long_are_refused_at_once() {
    let text = plan().to_toml().unwrap();
    let deep = [text.as_str(), "\nsweep = ", &"[".repeat(100_000)].concat();
    assert!(Plan::<VibratedBox>::from_toml(&deep).is_err());
    let count = 1_000_001;
    let values: Vec<f64> = (0..count).map(f64::from).collect();
    let ramp = Ramp::new("gravity", values, Course::Up).unwrap();
    let error = plan().with_ramp(ramp).unwrap_err().to_string();
    assert!(error.contains("1000001"), "{error}");
    let values: Vec<f64> = (0..200_000).map(f64::from).collect();
    let ramp = Ramp::new("gravity", values, Course::UpAndDown).unwrap();
    assert_eq!(plan().with_ramp(ramp).unwrap().value_count(), 399_999, "in time that grows with it only");
}
