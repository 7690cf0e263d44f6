//! Parts in files.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Along, Part, Travel, Turning};
use crate::Kind;
use crate::boundary::VesselError;
use crate::boundary::brick::Brick;
use crate::boundary::conduct::Conduct;
use crate::boundary::vector::unit_vector;
use crate::wall::Motion;

/// A part as files hold it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Part")]
pub(super) struct Record {
    bricks: Vec<Brick>,
    travel: Course,
    conduct: Conduct,
    kind: Kind,
    surface_speed: f64,
    #[serde(default)]
    start: f64,
}

/// The motion of a part as files hold it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case", rename = "Travel")]
enum Course {
    Rest,
    Along { direction: DVec2, motion: Motion },
    Turning { about: DVec2, angular_velocity: f64 },
    Spinning { about: DVec2, angular_velocity: f64 },
    TurningAlong { about: DVec2, angular_velocity: f64, direction: DVec2, motion: Motion },
}

impl From<Travel> for Course {
    fn from(travel: Travel) -> Self {
        match (travel.along, travel.turning) {
            (None, None) => Self::Rest,
            (Some(Along { direction, motion }), None) => Self::Along { direction, motion },
            (None, Some(Turning { about, angular_velocity, is_round: true })) => {
                Self::Spinning { about, angular_velocity }
            }
            (None, Some(Turning { about, angular_velocity, .. })) => {
                Self::Turning { about, angular_velocity }
            }
            (Some(Along { direction, motion }), Some(Turning { about, angular_velocity, .. })) => {
                Self::TurningAlong { about, angular_velocity, direction, motion }
            }
        }
    }
}

impl Course {
    /// Gives a part at rest this motion.
    fn of(self, part: Part) -> Result<Part, VesselError> {
        match self {
            Self::Rest => Ok(part),
            Self::Along { direction, motion } => {
                part.moving(Along { direction: unit_vector(direction)?, motion })
            }
            Self::Turning { about, angular_velocity } | Self::Spinning { about, angular_velocity } => {
                part.with_rotation(about, angular_velocity)
            }
            Self::TurningAlong { about, angular_velocity, direction, motion } => {
                Self::Along { direction, motion }.of(part.with_rotation(about, angular_velocity)?)
            }
        }
    }
}

impl From<Part> for Record {
    fn from(part: Part) -> Self {
        let Part { mut bricks, given, travel, conduct, kind, surface_speed, start } = part;
        bricks.truncate(given);
        Self { bricks, travel: travel.into(), conduct, kind, surface_speed, start }
    }
}

impl TryFrom<Record> for Part {
    type Error = VesselError;

    fn try_from(record: Record) -> Result<Self, VesselError> {
        let Record { bricks, travel, conduct, kind, surface_speed, start } = record;
        let part = Part { kind, ..Part::new(bricks)?.with_conduct(conduct) };
        travel.of(part.with_surface_speed(surface_speed)?.starting_at(start)?)
    }
}
