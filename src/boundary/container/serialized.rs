//! Containers in files.

use std::error::Error;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Container, Wall};
use crate::Kind;
use crate::boundary::conduct::Conduct;
use crate::boundary::plane::{Plane, Slide};
use crate::quantity::finite;
use crate::wall::Motion;

/// A container as it stands in a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Container")]
pub(super) struct Record {
    corner: DVec2,
    width: f64,
    /// Height of the lid or period of the ends; none if the top is open.
    height: Option<f64>,
    walls: Vec<WallRecord>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "ContainerWall")]
struct WallRecord {
    wall: Wall,
    motion: Motion,
    conduct: Conduct,
    kind: Kind,
    #[serde(default)]
    slide: Option<Slide>,
}

impl From<Container> for Record {
    fn from(container: Container) -> Self {
        let walls = container.walls.into_iter().zip(container.planes).map(|(wall, plane)| {
            let Plane { motion, conduct, kind, slide, .. } = plane;
            WallRecord { wall, motion, conduct, kind, slide }
        });
        let height = container.height.is_finite().then_some(container.height);
        Self { corner: container.corner, width: container.width, height, walls: walls.collect() }
    }
}

impl TryFrom<Record> for Container {
    type Error = Box<dyn Error>;

    fn try_from(record: Record) -> Result<Self, Box<dyn Error>> {
        let Record { corner, width, height, walls } = record;
        let has = |wall: Wall| walls.iter().any(|record| record.wall == wall);
        let mut container = match height {
            Some(height) => Self::closed(width, height)?,
            None => Self::open(width)?,
        };
        if !has(Wall::Left) {
            container = container.with_periodic_sides()?;
        }
        if !has(Wall::Floor) {
            container = container.with_periodic_ends()?;
        }
        // The walls must be those of the container as it is now, in their order.
        if !walls.iter().map(|record| record.wall).eq(container.walls.iter().copied()) {
            return Err("no container has just these walls in this order".into());
        }
        for (plane, record) in container.planes.iter_mut().zip(walls) {
            plane.set_motion(record.motion);
            (plane.conduct, plane.kind) = (record.conduct, record.kind);
            if let Some(Slide::Speed(speed)) = record.slide {
                finite("surface speed", speed)?;
            }
            plane.slide = record.slide;
        }
        Ok(container.shifted(corner)?)
    }
}
