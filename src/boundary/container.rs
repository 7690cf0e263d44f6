//! The rectangular container.

mod answers;
mod parts;

use glam::DVec2;

use super::domain::finite_point;
use super::parts::Parts;
use super::plane::Plane;
use super::surface::Conduct;
use super::{Thermal, Wall, WallError};
use crate::boundary::plane::Slide;
use crate::collision::CollisionRule;
use crate::quantity::{accept, finite, positive};
use crate::wall::{Combined, Motion, Piston, Stroke, WallMotion};
use crate::{Kind, ParameterError};

/// A rectangular container, such as the paper's box, with [parts](super::Part) of any shape in it. Its lower
/// left corner is at the origin unless it is [shifted](Self::shifted).
///
/// All walls are fixed initially, and follow the rule of the disks. Each wall can be given a motion along its
/// normal (which points inward), its own rule, a temperature, or a kind. Parts are added and
/// removed by name, even between runs
/// ([`Simulation::set_boundary`](crate::simulation::Simulation::set_boundary)).
///
/// Initial states keep clear of all parts at their positions at time 0. To pack disks densely among parts
/// that move, pack them with the same parts at rest.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
/// use granular_edmd::collision::Smooth;
/// use granular_edmd::wall::BiParabolic;
///
/// // The paper's vibrated box, and the narrow open box with a thermal base of its Fig. 2.
/// let vibrated = Container::closed(60.0, 150.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
/// let heated = Container::open(25.0)?.with_temperature(Wall::Floor, Thermal::new(1.0)?)?;
/// // Periodic sides, and smooth sides.
/// let periodic = Container::closed(60.0, 150.0)?.with_periodic_sides()?;
/// let smooth_sides = Container::open(60.0)?
///     .with_rule(Wall::Left, Smooth::from_inelasticity(0.0)?)?
///     .with_rule(Wall::Right, Smooth::from_inelasticity(0.0)?)?;
/// assert!(smooth_sides.with_motion(Wall::Lid, BiParabolic::new(0.1, 10.0)?).is_err(), "there is no lid");
/// assert_eq!((vibrated.wall_count(), vibrated.wall(3, 0.0).name.as_ref()), (4, "lid"));
/// assert_eq!((periodic.wall_count(), periodic.wall(1, 0.0).name.as_ref()), (2, "lid"));
/// assert_eq!(heated.domain().top, f64::INFINITY);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Container {
    /// Lower left corner.
    corner: DVec2,
    width: f64,
    /// Height of the lid or period of the ends; infinite if the top is open.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::gate::if_finite"))]
    height: f64,
    /// The existing walls.
    #[cfg_attr(feature = "serde", serde(rename = "walls"))]
    planes: Vec<Plane>,
    /// The parts, if there are any.
    #[cfg_attr(feature = "serde", serde(serialize_with = "parts::named"))]
    parts: Option<Box<Parts>>,
    /// The time origin, from which the phases of parts follow.
    #[cfg_attr(feature = "serde", serde(skip))]
    origin: f64,
}

impl Container {
    /// Creates a container with a lid.
    ///
    /// # Errors
    /// If the width or the height is not finite and positive.
    pub fn closed(width: f64, height: f64) -> Result<Self, ParameterError> {
        let mut container = Self::open(width)?;
        container.height = positive("height", height)?;
        container.planes.push(Plane::new(Wall::Lid, DVec2::NEG_Y, -height));
        Ok(container)
    }

    /// Creates a container without a lid.
    ///
    /// # Errors
    /// If the width is not finite and positive.
    pub fn open(width: f64) -> Result<Self, ParameterError> {
        let width = positive("width", width)?;
        let floor = Plane::new(Wall::Floor, DVec2::Y, 0.0);
        let left = Plane::new(Wall::Left, DVec2::X, 0.0);
        let right = Plane::new(Wall::Right, DVec2::NEG_X, -width);
        let planes = vec![floor, left, right];
        let (corner, height, origin) = (DVec2::ZERO, f64::INFINITY, 0.0);
        Ok(Self { corner, width, height, planes, parts: None, origin })
    }

    /// Creates a container without walls, which is periodic in both directions.
    ///
    /// A disk that leaves on one side enters on the other, and a disk that leaves above enters below, and
    /// vice versa. A simulation needs a width and a height of more than four diameters of the largest disk.
    ///
    /// # Errors
    /// If the width or the height is not finite and positive.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container};
    /// let container = Container::periodic(20.0, 30.0)?;
    /// assert_eq!(container.wall_count(), 0);
    /// assert!(container.domain().periodic_sides && container.domain().periodic_ends);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn periodic(width: f64, height: f64) -> Result<Self, ParameterError> {
        Ok(Self { planes: Vec::new(), ..Self::closed(width, height)? })
    }

    /// Returns the same container with periodic sides: a disk that leaves on one side enters on the other.
    ///
    /// A simulation needs a width of more than four diameters of the largest disk.
    ///
    /// # Errors
    /// If a side has a motion, a rule, a temperature or a kind, which would be lost.
    pub fn with_periodic_sides(self) -> Result<Self, WallError> {
        self.without([Wall::Left, Wall::Right])
    }

    /// Returns the same container with periodic ends: a disk that leaves above enters below, and vice versa.
    ///
    /// Gravity then keeps driving the disks down, as in a pipe.
    ///
    /// # Errors
    /// If the container is open above, or the floor or the lid has a motion, a rule, a temperature or a kind,
    /// which would be lost.
    pub fn with_periodic_ends(self) -> Result<Self, WallError> {
        if self.height.is_infinite() {
            return Err(WallError::Missing { wall: Wall::Lid });
        }
        self.without([Wall::Floor, Wall::Lid])
    }

    /// Returns the same container with a wall that moves along its normal. The normal points inward.
    ///
    /// # Errors
    /// If the container has no such wall, if the motion gives numbers that are not finite at one of the
    /// phases that [`check_finite`](crate::wall::check_finite) examines, if the wall is a piston already, or
    /// if the opposite wall is a piston that could meet this one.
    pub fn with_motion(
        mut self,
        wall: Wall,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let plane = self.plane_mut(wall)?;
        plane.set_motion(Motion::new(motion).map_err(|violation| WallError::Motion { violation })?)?;
        self.check_stops()?;
        self.changed()
    }

    /// Returns the same container with a wall that has a mass, and that the disks push along its normal.
    ///
    /// Initial states keep clear of the wall at its position at the start. An impact of a disk changes the
    /// times at which other disks meet the wall. Each impact therefore costs a pass over all disks, and new
    /// predictions for the flights that may meet the wall.
    ///
    /// Only the stops of a piston keep it away from the opposite wall: walls do not collide with each other.
    ///
    /// # Errors
    /// If the container has no such wall, the motion of the piston has numbers that are not finite, the wall
    /// already has another motion, or the piston's highest stop is beyond the nearest position of the
    /// opposite wall.
    pub fn with_piston(self, wall: Wall, piston: Piston) -> Result<Self, WallError> {
        self.with_motion(wall, Stroke::from(piston))
    }

    /// Returns the same container with a wall at which disks collide by this rule instead of their own.
    ///
    /// A wall has one response: a rule, a temperature and an absorbing wall replace each other.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_rule(
        mut self,
        wall: Wall,
        rule: impl CollisionRule + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        self.plane_mut(wall)?.conduct = Conduct::rule(rule);
        Ok(self)
    }

    /// Returns the same container with a thermal wall.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_temperature(mut self, wall: Wall, thermal: Thermal) -> Result<Self, WallError> {
        self.plane_mut(wall)?.conduct = Conduct::Thermal(thermal);
        Ok(self)
    }

    /// Returns the same container with a wall that takes each disk out of the run at its first touch, as an
    /// [absorbing part](super::Part::absorbing) does.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn absorbing(mut self, wall: Wall) -> Result<Self, WallError> {
        self.plane_mut(wall)?.conduct = Conduct::Absorbing;
        Ok(self)
    }

    /// Returns the same container with a wall of this kind, which rules read from the contact.
    ///
    /// # Errors
    /// If the container has no such wall.
    pub fn with_kind(mut self, wall: Wall, kind: Kind) -> Result<Self, WallError> {
        self.plane_mut(wall)?.kind = kind;
        Ok(self)
    }

    /// Returns the same container with its lower left corner and all parts moved by this vector.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container};
    /// use granular_edmd::glam::DVec2;
    /// let container = Container::closed(4.0, 3.0)?.shifted(DVec2::new(-2.0, 1.0))?;
    /// let domain = container.domain();
    /// assert_eq!((domain.left, domain.right, domain.bottom, domain.top), (-2.0, 2.0, 1.0, 4.0));
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn shifted(mut self, by: DVec2) -> Result<Self, WallError> {
        self.corner += by;
        finite_point(self.corner)?;
        for plane in &mut self.planes {
            plane.shift(by);
        }
        let parts = self.take_parts().into_iter().map(|placed| Ok((placed.name, placed.part.shifted(by)?)));
        let parts: Vec<_> = parts.collect::<Result<_, WallError>>()?;
        self.with_parts(parts)
    }

    /// Returns the width.
    pub const fn width(&self) -> f64 {
        self.width
    }

    /// Returns the height of the lid, or the period between periodic ends; infinite if the top is open.
    pub const fn height(&self) -> f64 {
        self.height
    }

    /// Returns the index of a wall, or `None` if the container has no such wall.
    pub fn index(&self, wall: Wall) -> Option<usize> {
        self.planes.iter().position(|plane| plane.wall == wall)
    }

    /// Removes these walls, if they exist.
    fn without(mut self, walls: [Wall; 2]) -> Result<Self, WallError> {
        for wall in walls {
            let Some(index) = self.index(wall) else { continue };
            if !self.planes.remove(index).is_plain() {
                return Err(WallError::Lost { wall });
            }
        }
        self.changed()
    }

    /// Checks that no piston can pass through the opposite wall.
    fn check_stops(&self) -> Result<(), ParameterError> {
        for piston in &self.planes {
            let Some(stroke) = piston.motion.stroke() else { continue };
            let gap = self.planes.iter().find_map(|plane| piston.least_gap(plane));
            let (name, rule) = ("highest stop of a piston", "before the nearest place of the opposite wall");
            accept(gap.is_none_or(|gap| gap >= 0.0), name, rule, stroke.reach().1)?;
        }
        Ok(())
    }

    fn plane_mut(&mut self, wall: Wall) -> Result<&mut Plane, WallError> {
        self.planes.iter_mut().find(|plane| plane.wall == wall).ok_or(WallError::Missing { wall })
    }
}

crate::gate::from_file! {
    Container {
        corner: DVec2, width: f64, height: Option<f64>, walls: Vec<Plane>, parts: Vec<(String, super::Part)>
    } => {
        let has = |wall: Wall| walls.iter().any(|plane| plane.wall == wall);
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
        // The walls in the file must be the container's present walls, in the same order.
        if !walls.iter().map(|plane| plane.wall).eq(container.planes.iter().map(|plane| plane.wall)) {
            return Err("no container has just these walls in this order".into());
        }
        for (plane, read) in container.planes.iter_mut().zip(walls) {
            if let Some(super::plane::Slide::Speed(speed)) = read.slide {
                crate::quantity::finite("surface speed", speed)?;
            }
            plane.set_motion(read.motion)?;
            (plane.conduct, plane.kind, plane.slide) = (read.conduct, read.kind, read.slide);
        }
        container.check_stops()?;
        Ok(container.shifted(corner)?.with_parts(parts)?)
    }, Box<dyn std::error::Error>
}

impl Container {
    /// Returns the same container with a wall whose surface moves tangentially at this speed, like a conveyor
    /// belt.
    ///
    /// A positive speed moves floor and lid to the right, and the sides up.
    ///
    /// # Errors
    /// If the container has no such wall, if the wall already slides, or if the speed is not finite.
    ///
    /// ```
    /// use granular_edmd::boundary::{Container, Wall};
    /// // A shear cell: the lid moves to the right, the floor to the left.
    /// let cell = Container::closed(20.0, 10.0)?
    ///     .with_periodic_sides()?
    ///     .with_surface_speed(Wall::Lid, 0.5)?
    ///     .with_surface_speed(Wall::Floor, -0.5)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_surface_speed(mut self, wall: Wall, speed: f64) -> Result<Self, WallError> {
        let speed = finite("surface speed", speed)?;
        self.plane_mut(wall)?.set_slide(Slide::Speed(speed))?;
        Ok(self)
    }

    /// Returns the same container with a wall that slides tangentially.
    ///
    /// A positive displacement moves floor and lid to the right, and the sides up. The wall may also move
    /// along its normal.
    ///
    /// # Errors
    /// The same as for [`with_motion`](Self::with_motion), and if the wall slides already.
    pub fn with_sliding(
        mut self,
        wall: Wall,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let motion = Motion::new(motion).map_err(|violation| WallError::Motion { violation })?;
        self.plane_mut(wall)?.set_slide(Slide::Motion { motion, phase: 0.0 })?;
        Ok(self)
    }

    /// Returns the same container, shaken sideways as a whole.
    ///
    /// Side walls move along their normals; floor and lid slide. Parts keep their own motions.
    ///
    /// Vertical motions that were set before are kept, so the floor or the box can move vertically, too.
    ///
    /// # Errors
    /// If the motion gives numbers that are not finite, as for [`with_motion`](Self::with_motion), or jumps,
    /// as a [`Sawtooth`](crate::wall::Sawtooth) does, if a side moves already, or if the floor or the lid
    /// slides already.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container, Wall};
    /// use granular_edmd::wall::{BiParabolic, Sinusoidal};
    /// let container = Container::closed(60.0, 150.0)?
    ///     .with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?
    ///     .shaken_sideways(Sinusoidal::new(0.5, 3.0)?)?;
    /// assert_eq!((container.domain().left, container.domain().right), (-0.5, 60.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn shaken_sideways(self, motion: impl WallMotion + Send + Sync + 'static) -> Result<Self, WallError> {
        self.shaken([Wall::Left, Wall::Right], [Wall::Floor, Wall::Lid], motion)
    }

    /// Returns the same container, shaken up and down as a whole.
    ///
    /// Floor and lid move along their normals; the sides slide.
    ///
    /// Horizontal motions that were set before are kept.
    ///
    /// # Errors
    /// The same as for [`shaken_sideways`](Self::shaken_sideways), with the walls exchanged.
    pub fn shaken_vertically(
        self,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        self.shaken([Wall::Floor, Wall::Lid], [Wall::Left, Wall::Right], motion)
    }

    /// Moves a pair of walls along their normals, which are opposite, with mirrored motions, and lets the
    /// other walls slide.
    fn shaken(
        mut self,
        pair: [Wall; 2],
        others: [Wall; 2],
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let [first, second] = pair;
        let motion = Motion::new(motion).map_err(|violation| WallError::Motion { violation })?;
        let mirrored = Combined::of(motion.clone()).scaled(-1.0);
        let mirrored = mirrored.map_err(|_| WallError::Jump)?;
        if self.planes.is_empty() {
            return Err(WallError::Missing { wall: first });
        }
        for (wall, motion) in [(first, motion.clone()), (second, Motion::of(mirrored))] {
            if let Ok(plane) = self.plane_mut(wall) {
                if plane.motion.reach() != (0.0, 0.0) {
                    return Err(WallError::Lost { wall });
                }
                plane.set_motion(motion)?;
            }
        }
        for wall in others {
            if let Ok(plane) = self.plane_mut(wall) {
                plane.set_slide(Slide::Motion { motion: motion.clone(), phase: 0.0 })?;
            }
        }
        self.changed()
    }
}
