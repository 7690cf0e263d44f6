//! Parts in files.

use serde::{Deserialize, Serialize};

use super::{Part, Travel};
use crate::Kind;
use crate::boundary::VesselError;
use crate::boundary::brick::Brick;
use crate::boundary::conduct::Conduct;
use crate::boundary::vector::{finite_point, unit_vector};
use crate::quantity::finite;

/// A part as files hold it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Part")]
pub(super) struct Record {
    bricks: Vec<Brick>,
    travel: Travel,
    conduct: Conduct,
    kind: Kind,
    surface_speed: f64,
    #[serde(default)]
    start: f64,
}

impl From<Part> for Record {
    fn from(part: Part) -> Self {
        let Part { mut bricks, given, travel, conduct, kind, surface_speed, start } = part;
        bricks.truncate(given);
        Self { bricks, travel, conduct, kind, surface_speed, start }
    }
}

impl TryFrom<Record> for Part {
    type Error = VesselError;

    fn try_from(record: Record) -> Result<Self, VesselError> {
        let Record { bricks, travel, conduct, kind, surface_speed, start } = record;
        let part = Part { conduct, kind, ..Part::new(bricks)? };
        let part = part.with_surface_speed(surface_speed)?.starting_at(start)?;
        match &travel {
            Travel::Along { direction, .. } => {
                unit_vector(*direction)?;
                part.traveling(travel)
            }
            Travel::Turning { about, angular_velocity } | Travel::Spinning { about, angular_velocity } => {
                finite_point(*about)?;
                part.with_rotation(*about, finite("angular velocity", *angular_velocity)?)
            }
            Travel::Rest => Ok(part),
        }
    }
}
