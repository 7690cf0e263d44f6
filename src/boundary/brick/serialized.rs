//! Bricks in files.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::arc::{Arc, Sector};
use super::segment::Segment;
use super::{Brick, Free, Shape};
use crate::boundary::VesselError;
use crate::boundary::vector::{finite_point, unit_vector};
use crate::quantity::accept;

/// The form of a brick in a file.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case", rename = "Brick")]
pub(super) enum Record {
    Segment { from: DVec2, to: DVec2, free: Free },
    HalfLine { from: DVec2, direction: DVec2, free: Free },
    Circle { center: DVec2, radius: f64, free: Free },
    Arc { center: DVec2, radius: f64, start: DVec2, end: DVec2, is_wide: bool, free: Free },
    Point { place: DVec2 },
}

impl From<Brick> for Record {
    fn from(Brick { shape, free }: Brick) -> Self {
        match shape {
            Shape::Segment(segment) => match segment.to() {
                Some(to) => Self::Segment { from: segment.from, to, free },
                None => Self::HalfLine { from: segment.from, direction: segment.direction, free },
            },
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
    type Error = VesselError;

    fn try_from(record: Record) -> Result<Self, VesselError> {
        match record {
            Record::Segment { from, to, free } => Ok(Self { free, ..Self::segment(from, to)? }),
            Record::HalfLine { from, direction, free } => {
                let (from, direction) = (finite_point(from)?, unit_vector(direction)?);
                Ok(Self { shape: Shape::Segment(Segment::endless(from, direction)), free })
            }
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
