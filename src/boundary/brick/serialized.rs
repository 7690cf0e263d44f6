//! Bricks in files.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::shapes::{Arc, Sector};
use super::{Brick, Free, Shape};
use crate::boundary::WallError;
use crate::boundary::domain::unit_vector;
use crate::quantity::accept;

/// The form of a brick in a file.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case", rename = "Brick")]
pub(super) enum Record {
    Segment { from: DVec2, to: DVec2, free: Free },
    Circle { center: DVec2, radius: f64, free: Free },
    Arc { center: DVec2, radius: f64, start: DVec2, end: DVec2, is_wide: bool, free: Free },
    Point { place: DVec2 },
}

impl From<Brick> for Record {
    fn from(Brick { shape, free }: Brick) -> Self {
        match shape {
            Shape::Segment(segment) => Self::Segment { from: segment.from, to: segment.to, free },
            Shape::Arc(arc) => match arc.sector {
                Some(Sector { start, end, is_wide }) => {
                    Self::Arc { center: arc.center, radius: arc.radius, start, end, is_wide, free }
                }
                None if arc.radius == 0.0 => Self::Point { place: arc.center },
                None => Self::Circle { center: arc.center, radius: arc.radius, free },
            },
        }
    }
}

impl TryFrom<Record> for Brick {
    type Error = WallError;

    fn try_from(record: Record) -> Result<Self, WallError> {
        match record {
            Record::Segment { from, to, free } => Ok(Self { free, ..Self::segment(from, to)? }),
            Record::Circle { center, radius, free } => Ok(Self { free, ..Self::circle(center, radius)? }),
            Record::Arc { center, radius, start, end, is_wide, free } => {
                Self::circle(center, radius)?;
                let (start, end) = (unit_vector(start)?, unit_vector(end)?);
                accept(start != end, "angle of an arc", "above 0 and less than 2π", 0.0)?;
                let sector = Some(Sector { start, end, is_wide });
                Ok(Self { shape: Shape::Arc(Arc { center, radius, sector }), free })
            }
            Record::Point { place } => Self::point(place),
        }
    }
}
