//! Constructors of parts.

use glam::DVec2;

use super::{Part, Travel, corners, polygon};
use crate::boundary::WallError;
use crate::boundary::brick::Brick;
use crate::boundary::conduct::Conduct;
use crate::quantity::accept;
use crate::{Disk, Kind};

impl Part {
    /// Creates a part of these bricks, and adds points at the ends that disks can touch.
    ///
    /// A one-sided brick has the wall behind it. A brick with a free end should therefore be
    /// [two-sided](Brick::two_sided), because disks can come around the end.
    ///
    /// # Errors
    /// If there are no bricks.
    pub fn new(bricks: impl IntoIterator<Item = Brick>) -> Result<Self, WallError> {
        let bricks: Vec<Brick> = bricks.into_iter().collect();
        accept(!bricks.is_empty(), "number of bricks", "at least 1", 0.0)?;
        let (corners, travel) = (corners::corners(&bricks), Travel::default());
        let (conduct, kind) = (Conduct::Shared, Kind::WALL);
        Ok(Self { bricks, corners, travel, conduct, kind, surface_speed: 0.0, start: 0.0, kinds: None })
    }

    /// Creates a closed polygon with the disks inside.
    ///
    /// The points may be in either order around the polygon, and the last one may repeat the first. Brick 0
    /// is between the first two points.
    ///
    /// # Errors
    /// If there are fewer than three points, a coordinate is not finite, neighboring points are equal, the
    /// polygon has no area, or two of its sides cross.
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// use granular_edmd::glam::DVec2;
    /// // Points from a table of two columns, as a drawing program or a script writes them.
    /// let rows = "0 0\n4 0\n0 3".lines().map(|line| line.split_whitespace().map(str::parse));
    /// let rows = rows.map(Iterator::collect).collect::<Result<Vec<Vec<f64>>, _>>()?;
    /// let triangle = Part::polygon(rows.iter().map(|row| DVec2::from_slice(row)))?;
    /// assert_eq!(triangle.bricks().len(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn polygon(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        Self::new(polygon::sides(points.into_iter().collect(), true)?)
    }

    /// Creates a closed polygon with the disks outside: a solid block.
    ///
    /// The points may be in either order around the block.
    ///
    /// # Errors
    /// The same as for [`polygon`](Self::polygon).
    ///
    /// ```
    /// use granular_edmd::boundary::Part;
    /// use granular_edmd::glam::DVec2;
    /// let ramp = Part::block([DVec2::ZERO, DVec2::new(9.0, 0.0), DVec2::new(0.0, 6.0)])?;
    /// assert!(ramp.signed_distance(DVec2::new(1.0, 1.0)) < 0.0);
    /// assert_eq!(ramp.signed_distance(DVec2::new(-2.0, 1.0)), 2.0);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn block(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        Self::new(polygon::sides(points.into_iter().collect(), false)?)
    }

    /// Creates a thin wall from point to point, with disks on both sides.
    ///
    /// Initial states put disks on both sides, too. For a solid body, use [`block`](Self::block).
    ///
    /// # Errors
    /// If there are fewer than two points, a coordinate is not finite, or neighboring points are equal.
    pub fn polyline(points: impl IntoIterator<Item = DVec2>) -> Result<Self, WallError> {
        let points: Vec<DVec2> = points.into_iter().collect();
        accept(points.len() >= 2, "number of points", "at least 2", points.len() as f64)?;
        let bricks = points.windows(2).map(|pair| Ok(Brick::segment(pair[0], pair[1])?.two_sided()));
        Self::new(bricks.collect::<Result<Vec<_>, WallError>>()?)
    }

    /// Creates a circle with the disks inside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn drum(center: DVec2, radius: f64) -> Result<Self, WallError> {
        Self::new([Brick::circle(center, radius)?])
    }

    /// Creates a circle with the disks outside.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the radius is not finite and positive.
    pub fn peg(center: DVec2, radius: f64) -> Result<Self, WallError> {
        Self::new([Brick::circle(center, radius)?.reversed()])
    }
}

impl Part {
    /// Creates a peg with the position, the radius and the kind of a disk.
    pub(in crate::boundary) fn peg_of(disk: &Disk) -> Result<Self, WallError> {
        let peg = Self::peg(disk.position(), disk.radius())?;
        Ok(if disk.kind() == Kind::DEFAULT { peg } else { peg.with_kind(disk.kind()) })
    }
}

crate::gate::from_file! {
    Part {
        bricks: Vec<Brick>, travel: Travel, conduct: Conduct, kind: Kind, surface_speed: f64, #[serde(default)] start: f64,
        #[serde(default)] only_for: Vec<Kind>
    } => {
        let part = Self { kind, ..Self::new(bricks)?.with_conduct(conduct) };
        let part = if only_for.is_empty() { part } else { part.only_for(only_for) };
        let mut part = part.with_surface_speed(surface_speed)?.starting_at(start)?;
        if let Some(super::Turning { about, angular_velocity, .. }) = travel.turning {
            part = part.with_rotation(about, angular_velocity)?;
        }
        let Some(super::Along { direction, motion }) = travel.along else { return Ok(part) };
        part.moving(super::Along { direction: crate::boundary::vector::unit_vector(direction)?, motion })
    }, WallError
}
