//! The simulated runs: ramps of friction, up and down, side by side for each inelasticity.

use clap::ValueEnum;
use granular_edmd::ParameterError;
use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Axis, Course, Plan, PlanError, Protocol, Ramp};

/// The size of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Size {
    /// A few values of each parameter, for half a minute: the picture in rough outlines.
    Quick,
    /// All frictions and inelasticities, 6000 oscillations each: six minutes on one core.
    Coarse,
    /// The paper's: 100 000 oscillations each, all ramps up and down: about three hours on one core.
    Full,
}

impl Size {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Coarse => "coarse",
            Self::Full => "full",
        }
    }
}

/// The two gravities of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Gravity {
    /// 0.002025.
    #[value(name = "0.002025")]
    Small,
    /// 0.015625.
    #[value(name = "0.015625")]
    Large,
}

impl Gravity {
    pub(crate) const fn value(self) -> f64 {
        match self {
            Self::Small => 0.002_025,
            Self::Large => 0.015_625,
        }
    }
}

/// Frictions from 0.005 to 3, with about equal steps of the logarithm, and smaller ones where one roll gives
/// way to two.
const FRICTIONS: [f64; 26] = [
    0.005, 0.007_5, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.055, 0.06, 0.065, 0.07, 0.085, 0.1, 0.15, 0.2,
    0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.7, 2.2, 3.0,
];

const FEW_FRICTIONS: [f64; 8] = [0.005, 0.015, 0.04, 0.07, 0.15, 0.3, 1.0, 3.0];

/// A study in a separate folder.
pub(crate) struct Part {
    pub(crate) folder: &'static str,
    pub(crate) plan: Plan<VibratedBox>,
}

/// Returns the studies of a phase diagram: the ramps up, and the ramps down.
pub(crate) fn parts(size: Size, gravity: Gravity, seed: u64) -> Result<Vec<Part>, PlanError> {
    let up = inelasticities(size, gravity);
    // The ramps down show hysteresis. A short run cannot distinguish hysteresis from a late start.
    let down = match size {
        Size::Quick => Vec::new(),
        Size::Coarse => up.iter().copied().step_by(2).take(4).collect(),
        Size::Full => up.clone(),
    };
    let parts = [("up", Course::Up, up), ("down", Course::Down, down)];
    let wanted = parts.into_iter().filter(|(_, _, inelasticities)| !inelasticities.is_empty());
    wanted
        .map(|(folder, course, inelasticities)| {
            let plan = plan(size, gravity, seed, course, inelasticities)?;
            Ok(Part { folder, plan })
        })
        .collect()
}

fn plan(
    size: Size,
    gravity: Gravity,
    seed: u64,
    course: Course,
    inelasticities: Vec<f64>,
) -> Result<Plan<VibratedBox>, PlanError> {
    let experiment = gallery::studies::vibrated_box(gravity.value());
    let frictions = if size == Size::Quick { FEW_FRICTIONS.to_vec() } else { FRICTIONS.to_vec() };
    Plan::new(experiment, protocol(size)?, seed)?
        .with_ramp(Ramp::new("friction", frictions, course)?)?
        .with_axis(Axis::new("inelasticity", inelasticities)?)
}

/// Returns the protocol, which discards the first half.
fn protocol(size: Size) -> Result<Protocol, ParameterError> {
    match size {
        Size::Quick => Protocol::new(750, 150, 5),
        Size::Coarse => Protocol::new(3_000, 300, 10),
        Size::Full => Protocol::new(50_000, 500, 100),
    }
}

/// Returns inelasticities in equal steps, which are larger for the smaller gravity.
fn inelasticities(size: Size, gravity: Gravity) -> Vec<f64> {
    let (step, most) = match gravity {
        Gravity::Small => (0.02, 12),
        Gravity::Large => (0.005, 12),
    };
    let every = if size == Size::Quick { 2 } else { 1 };
    (0..most).step_by(every).map(|number| f64::from(number) * step).collect()
}
