//! What is simulated: ramps of friction, up and down, side by side for each inelasticity.

use clap::ValueEnum;
use granular_edmd::study::{
    Axis, Base, Course, Parameter, Protocol, Ramp, Specification, SpecificationError, System,
};

/// How much is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Size {
    /// A few values of each parameter, for a minute or two: the picture in its roughest outlines.
    Quick,
    /// All frictions and inelasticities, 3500 oscillations each: most of an hour.
    Coarse,
    /// As in the paper, 100 000 oscillations each: days.
    Full,
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

    /// The largest inelasticity of the picture: the smaller gravity needs more loss for everything.
    pub(crate) const fn largest_inelasticity(self) -> f64 {
        match self {
            Self::Small => 0.2,
            Self::Large => 0.08,
        }
    }
}

/// Friction from 0.005 to 3: equal steps of its logarithm, some more where one roll gives way to two.
const FRICTIONS: [f64; 17] =
    [0.005, 0.01, 0.015, 0.025, 0.04, 0.05, 0.055, 0.06, 0.07, 0.1, 0.15, 0.25, 0.5, 0.8, 1.2, 2.0, 3.0];

const FEW_FRICTIONS: [f64; 8] = [0.005, 0.015, 0.04, 0.07, 0.15, 0.3, 1.0, 3.0];

/// A study in a folder of its own.
pub(crate) struct Part {
    pub(crate) folder: &'static str,
    pub(crate) specification: Specification,
}

/// The studies of a phase diagram: the ramps up, and the ramps down.
pub(crate) fn parts(size: Size, gravity: Gravity, seed: u64) -> Result<Vec<Part>, SpecificationError> {
    let up = inelasticities(size, gravity);
    // Going down is for hysteresis; a short run cannot tell it from a late start.
    let down = match size {
        Size::Quick => Vec::new(),
        Size::Coarse => vec![up[0], up[2]],
        Size::Full => up.clone(),
    };
    let parts = [("up", Course::Up, up), ("down", Course::Down, down)];
    let wanted = parts.into_iter().filter(|(_, _, inelasticities)| !inelasticities.is_empty());
    wanted
        .map(|(folder, course, inelasticities)| {
            let specification = specification(size, gravity, seed, course, inelasticities)?;
            Ok(Part { folder, specification })
        })
        .collect()
}

fn specification(
    size: Size,
    gravity: Gravity,
    seed: u64,
    course: Course,
    inelasticities: Vec<f64>,
) -> Result<Specification, SpecificationError> {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let system = System::new(1000, 60.0, base)
        .with_height(150.0)
        .with_gravity(gravity.value())
        .with_contact_duration(1e-4);
    let frictions = if size == Size::Quick { FEW_FRICTIONS.to_vec() } else { FRICTIONS.to_vec() };
    Specification::new(system, protocol(size), seed)?
        .with_ramp(Ramp::new(Parameter::Friction, frictions, course))?
        .with_axis(Axis::new(Parameter::Inelasticity, inelasticities))
}

/// The first half is discarded.
const fn protocol(size: Size) -> Protocol {
    match size {
        Size::Quick => Protocol::new(500, 100, 5),
        Size::Coarse => Protocol::new(1_500, 200, 10),
        Size::Full => Protocol::new(50_000, 500, 100),
    }
}

/// Equal steps, those of the smaller gravity being larger.
fn inelasticities(size: Size, gravity: Gravity) -> Vec<f64> {
    let (step, most) = match gravity {
        Gravity::Small => (0.025, 8),
        Gravity::Large => (0.01, 7),
    };
    let every = if size == Size::Quick { 3 } else { 1 };
    (0..most).step_by(every).map(|number| f64::from(number) * step).collect()
}
