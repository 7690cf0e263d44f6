//! Parts in files.

use serde::{Deserialize, Serialize};

use super::{Along, Part, Travel, Turning};
use crate::Kind;
use crate::boundary::VesselError;
use crate::boundary::brick::Brick;
use crate::boundary::conduct::Conduct;
use crate::boundary::vector::unit_vector;

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
        let Record { bricks, travel: Travel { along, turning }, conduct, kind, surface_speed, start } =
            record;
        let part = Part { kind, ..Part::new(bricks)?.with_conduct(conduct) };
        let mut part = part.with_surface_speed(surface_speed)?.starting_at(start)?;
        if let Some(Turning { about, angular_velocity, .. }) = turning {
            part = part.with_rotation(about, angular_velocity)?;
        }
        match along {
            Some(Along { direction, motion }) => {
                part.moving(Along { direction: unit_vector(direction)?, motion })
            }
            None => Ok(part),
        }
    }
}
