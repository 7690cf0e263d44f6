//! The rectangular container.

use std::sync::Arc;

use glam::DVec2;
use thiserror::Error;

use super::plane::{Conduct, Plane};
use super::{Boundary, Domain, Region, Surface, Thermal, Touch};
use crate::collision::CollisionRule;
use crate::quantity::positive;
use crate::wall::WallMotion;
use crate::{Flight, ParameterError};

/// A wall of a [`Container`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Wall {
    /// The base, at height 0.
    Floor,
    /// The upper end.
    Lid,
    /// The left side.
    Left,
    /// The right side.
    Right,
}

/// The container has no such wall: it is open above, or its sides are periodic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the container has no wall {wall:?}")]
#[non_exhaustive]
pub struct MissingWall {
    /// The wall asked for.
    pub wall: Wall,
}

/// A rectangular container with its lower left corner at the origin: the paper's box and its relatives.
///
/// All walls start fixed, under the rule that the disks have among themselves. Each can be given a motion along its
/// normal (which points inward), a rule of its own, or a temperature.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
/// use granular_edmd::collision::Smooth;
/// use granular_edmd::wall::BiParabolic;
///
/// // The paper's vibrated box, and the narrow open box with a thermal base of its Fig. 2.
/// let vibrated = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
/// let heated = Container::open(25.0)?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?;
/// // Other sides.
/// let periodic = Container::closed(60.0, 150.0)?.with_periodic_sides();
/// let smooth_sides = Container::open(60.0)?
///     .with_rule(Wall::Left, Smooth::new(0.0)?)?
///     .with_rule(Wall::Right, Smooth::new(0.0)?)?;
/// assert!(smooth_sides.with_motion(Wall::Lid, BiParabolic::new(0.1, 10.0)?).is_err(), "there is no lid");
/// assert_eq!(vibrated.walls(), ["floor", "left", "right", "lid"]);
/// assert_eq!(periodic.walls(), ["floor", "lid"]);
/// assert_eq!(heated.domain().top, f64::INFINITY);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Container {
    width: f64,
    /// Infinite without a lid.
    height: f64,
    kinds: Vec<Wall>,
    names: Vec<&'static str>,
    planes: Vec<Plane>,
}

impl Container {
    /// A container with a lid.
    ///
    /// # Errors
    /// If the width or the height is not finite and positive.
    pub fn closed(width: f64, height: f64) -> Result<Self, ParameterError> {
        let mut container = Self::open(width)?;
        container.height = positive("height", height)?;
        container.add(Wall::Lid, "lid", Plane::new(DVec2::NEG_Y, -height));
        Ok(container)
    }

    /// A container without a lid.
    ///
    /// # Errors
    /// If the width is not finite and positive.
    pub fn open(width: f64) -> Result<Self, ParameterError> {
        let width = positive("width", width)?;
        let mut container =
            Self { width, height: f64::INFINITY, kinds: Vec::new(), names: Vec::new(), planes: Vec::new() };
        container.add(Wall::Floor, "floor", Plane::new(DVec2::Y, 0.0));
        container.add(Wall::Left, "left", Plane::new(DVec2::X, 0.0));
        container.add(Wall::Right, "right", Plane::new(DVec2::NEG_X, -width));
        Ok(container)
    }

    /// The same container without side walls: what leaves on one side enters on the other.
    pub fn with_periodic_sides(mut self) -> Self {
        for wall in [Wall::Left, Wall::Right] {
            self.remove(wall);
        }
        self
    }

    /// The same container with a wall that moves along its normal, which points inward.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_motion(
        mut self,
        wall: Wall,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, MissingWall> {
        self.plane_mut(wall)?.set_motion(Arc::new(motion));
        Ok(self)
    }

    /// The same container with a wall that has a rule of its own.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_rule(
        mut self,
        wall: Wall,
        rule: impl CollisionRule + Send + Sync + 'static,
    ) -> Result<Self, MissingWall> {
        self.plane_mut(wall)?.set_conduct(Conduct::Rule(Arc::new(rule)));
        Ok(self)
    }

    /// The same container with a thermal wall.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_temperature(mut self, wall: Wall, thermal: Thermal) -> Result<Self, MissingWall> {
        self.plane_mut(wall)?.set_conduct(Conduct::Thermal(thermal));
        Ok(self)
    }

    /// Width `$L_x$`.
    pub const fn width(&self) -> f64 {
        self.width
    }

    /// Height `$L_y$` of the lid; infinite without one.
    pub const fn height(&self) -> f64 {
        self.height
    }

    /// The index of a wall, if it is there.
    pub fn index(&self, wall: Wall) -> Option<usize> {
        self.kinds.iter().position(|&kind| kind == wall)
    }

    fn add(&mut self, wall: Wall, name: &'static str, plane: Plane) {
        self.kinds.push(wall);
        self.names.push(name);
        self.planes.push(plane);
    }

    fn remove(&mut self, wall: Wall) {
        if let Some(index) = self.index(wall) {
            self.kinds.remove(index);
            self.names.remove(index);
            self.planes.remove(index);
        }
    }

    fn plane_mut(&mut self, wall: Wall) -> Result<&mut Plane, MissingWall> {
        let index = self.index(wall).ok_or(MissingWall { wall })?;
        Ok(&mut self.planes[index])
    }

    /// How far a wall can move outward.
    fn retreat(&self, wall: Wall) -> f64 {
        self.index(wall).map_or(0.0, |index| -self.planes[index].reach().0.min(0.0))
    }

    /// How far a wall can move inward.
    fn advance(&self, wall: Wall) -> f64 {
        self.index(wall).map_or(0.0, |index| self.planes[index].reach().1.max(0.0))
    }
}

impl Boundary for Container {
    fn domain(&self) -> Domain {
        Domain {
            left: -self.retreat(Wall::Left),
            right: self.width + self.retreat(Wall::Right),
            bottom: -self.retreat(Wall::Floor),
            top: self.height + self.retreat(Wall::Lid),
            periodic: self.index(Wall::Left).is_none(),
        }
    }

    fn interior(&self) -> Domain {
        Domain {
            left: self.advance(Wall::Left),
            right: self.width - self.advance(Wall::Right),
            bottom: self.advance(Wall::Floor),
            top: self.height - self.advance(Wall::Lid),
            periodic: self.index(Wall::Left).is_none(),
        }
    }

    fn wall_count(&self) -> usize {
        self.names.len()
    }
    fn wall_name(&self, wall: usize) -> std::borrow::Cow<'_, str> {
        self.names.get(wall).copied().unwrap_or("?").into()
    }

    fn set_time_origin(&mut self, origin: f64) {
        for plane in &mut self.planes {
            plane.set_time_origin(origin);
        }
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.planes.iter().any(|plane| plane.may_touch(region, radius))
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch> {
        let mut first = None;
        let mut until = until;
        for (wall, plane) in self.planes.iter().enumerate() {
            if let Some(time) = plane.first_touch(flight, until)
                && first.is_none_or(|touch: Touch| time < touch.time)
            {
                first = Some(Touch { time, wall });
                until = time;
            }
        }
        first
    }

    fn surface(&self, wall: usize, _position: DVec2, time: f64) -> Surface<'_> {
        self.planes[wall].surface(time)
    }

    fn overlap(&self, position: DVec2, radius: f64, time: f64) -> Option<(usize, f64)> {
        let depths = self.planes.iter().map(|plane| plane.depth(position, radius, time)).enumerate();
        depths.filter(|&(_, depth)| depth > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}
