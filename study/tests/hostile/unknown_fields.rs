//! Plans with a field too many, and plans too deep or too long.

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Course, Plan, Ramp};

use crate::studies::plan;

/// A plan refuses an unknown field by name, at each place.
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
