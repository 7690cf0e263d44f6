//! The command `granular-edmd`, which runs studies of the paper's box from plans in TOML.

use std::process::ExitCode;

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Course, Plan, PlanError, Protocol, Ramp, cli};

fn main() -> ExitCode {
    cli::main(example)
}

/// Returns a plan for a box smaller than the paper's, whose study takes a few minutes.
fn example() -> Result<Plan<VibratedBox>, PlanError> {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(200, 30.0, base)
        .with_height(80.0)
        .with_gravity(0.015_625)
        .with_contact_duration(1e-4);
    Plan::new(experiment, Protocol::new(2000, 100, 10)?, 1)?
        .with_ramp(Ramp::new("friction", [0.01, 0.03, 0.06, 0.1], Course::Up)?)?
        .with_axis(Axis::new("inelasticity", [0.0, 0.01])?)
}
