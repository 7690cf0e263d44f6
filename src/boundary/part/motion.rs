//! The position of a part, and its motion.

use glam::DVec2;

use super::{Along, Part, Travel, Turning};
use crate::boundary::brick::Brick;
use crate::boundary::domain::{direction, finite_point, unit};
use crate::boundary::{Region, WallError};
use crate::quantity::{accept, finite};
use crate::wall::{Motion, Piston, Stroke, WallMotion};

/// Position and motion.
impl Part {
    /// Returns the same part with a motion along a direction, in place of an earlier motion along a
    /// direction.
    ///
    /// The vector `direction` can have any length except 0. A part that also [turns](Self::with_rotation)
    /// moves along the same direction at all times, and the point about which it turns moves with it.
    ///
    /// # Errors
    /// If the direction has no length, if the motion gives numbers that are not finite at one of the phases
    /// that [`check_finite`](crate::wall::check_finite) examines, or if the motion jumps, as a
    /// [`Sawtooth`](crate::wall::Sawtooth) does, and disks are free on a side of the part toward which it
    /// would jump. For a part that turns, this side changes with time, so its motion may not jump at all.
    pub fn with_motion(
        self,
        direction: DVec2,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let direction = unit(direction)?;
        let motion = Motion::new(motion).map_err(|violation| WallError::Motion { violation })?;
        self.moving(Along { direction, motion })
    }

    /// Returns the same part with a mass, which slides along a direction, and which the disks push: in place
    /// of an earlier motion along a direction.
    ///
    /// The displacement of the piston counts along the vector `direction`, which can have any length except
    /// 0. The part is guided, so an impulse with the normal $`n`$ meets the mass $`M/(n\cdot e)^2`$ for the
    /// unit vector $`e`$ along the direction. Only the piston's stops hold the part: it collides with no
    /// other wall.
    ///
    /// Friction along the direction would push the part, too, for which a rule would have to know how
    /// impulses along the normal and along the surface depend on each other. A container therefore takes such
    /// a part only if disks cannot rub it along its direction: its own rule, or the slip of its temperature,
    /// lets them slide, or all of its bricks are straight, across the direction, and end at the edge of the
    /// domain or beyond.
    ///
    /// # Errors
    /// If the direction has no length, a number of the piston's motion is not finite, or the part turns.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    /// use granular_edmd::wall::Piston;
    ///
    /// // A partition that slides freely between two gases.
    /// let wall = Part::polyline([(10.0, 0.0), (10.0, 4.0)].map(DVec2::from))?;
    /// let wall = wall.with_piston(DVec2::X, Piston::new(50.0, [-8.0, 8.0])?)?;
    /// let cell = Container::closed(20.0, 4.0)?.with_part("partition", wall)?;
    /// let disk = Disk::new(DVec2::new(4.0, 2.0), 0.5)?.with_velocity(DVec2::X)?;
    /// let mut run = Simulation::builder(Elastic, cell).disks([disk]).build()?;
    /// run.run_until(6.0, &mut ())?;
    /// // The disk of mass 1 bounces off the mass 50.
    /// assert!((run.disks()[0].velocity().x + 49.0 / 51.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_piston(self, direction: DVec2, piston: Piston) -> Result<Self, WallError> {
        self.with_motion(direction, Stroke::from(piston))
    }

    /// Returns the same part, turning about a point, counterclockwise at this angular velocity, in place of
    /// an earlier rotation.
    ///
    /// With a [motion](Self::with_motion), the center of rotation moves with the part. With the center $`c`$,
    /// the direction $`e`$ and the displacement $`z`$, a point of the part that was built at $`r`$ is at the
    /// following position at the time $`t`$:
    ///
    /// ```math
    /// c + z(t)\,e + R(\omega t)\,(r - c),\qquad\text{at the velocity}\quad
    /// \dot z(t)\,e + \omega\,R(\omega t)\,(r - c)_\perp .
    /// ```
    ///
    /// A circle about that center stays in place; only its surface moves. At time 0 and after each whole
    /// turn, any other part is in the position in which it was built.
    ///
    /// # Errors
    /// If a number is not finite, if the angular velocity is so small or large that a turn would take more
    /// than 1e60 or less than 1e-60, or if the part has a mass or a motion that jumps. An angular velocity of
    /// 0 is allowed: the part then does not turn.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container, Part};
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::wall::Tabulated;
    ///
    /// // A stirrer that turns, and travels by 10 to the right in a time of 20.
    /// let stirrer = Part::polyline([DVec2::new(-3.0, 0.0), DVec2::new(3.0, 0.0)])?
    ///     .with_rotation(DVec2::ZERO, 1.0)?
    ///     .with_motion(DVec2::X, Tabulated::from_to(0.0, 10.0, 20.0)?)?;
    /// let container = Container::around([("stirrer", stirrer)])?;
    /// let wall = container.walls_of("stirrer").unwrap().start;
    /// // Halfway, its middle moves at the speed 1.
    /// let surface = container.surface(wall, DVec2::new(5.0, 0.0), 10.0);
    /// assert!(surface.velocity.distance(DVec2::X) < 1e-12);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn with_rotation(self, about: DVec2, angular_velocity: f64) -> Result<Self, WallError> {
        let about = finite_point(about)?;
        if finite("angular velocity", angular_velocity)? == 0.0 {
            return Ok(Self { travel: Travel { turning: None, ..self.travel }, ..self });
        }
        let turn = std::f64::consts::TAU / angular_velocity.abs();
        let range = "such that a turn takes from 1e-60 to 1e60";
        accept((1e-60..=1e60).contains(&turn), "angular velocity", range, angular_velocity)?;
        let is_round = self.all_bricks().all(|brick| brick.is_circle_about(about));
        let turning = Some(Turning { about, angular_velocity, is_round });
        Self { travel: Travel { turning, ..self.travel }, ..self }.safe()
    }

    /// Returns the same part with a motion whose phase counts from this absolute time instead of 0.
    ///
    /// A moving part that is added to a run should start at the present time. It then has the position in
    /// which it was built, if its motion has no displacement at phase 0. The start is not a delay: before it,
    /// the part goes through the phases before 0.
    ///
    /// # Errors
    /// If the time is not finite.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container, Part, Probe};
    /// use granular_edmd::glam::DVec2;
    ///
    /// let wheel = Part::block([(0.0, 0.0), (8.0, 0.0), (8.0, 1.0), (0.0, 1.0)].map(DVec2::from))?;
    /// let wheel = wheel.with_rotation(DVec2::new(4.0, 0.5), 0.7)?.starting_at(30.0)?;
    /// let container = Container::around([("wheel", wheel)])?;
    /// // At time 30 the wheel lies as it was built.
    /// let probe = Probe::new(DVec2::new(1.0, 1.25), 0.5, 0.0);
    /// let depth = |time| container.overlap(&probe.with_time(time)).map_or(0.0, |overlap| overlap.depth);
    /// assert!((depth(30.0) - 0.25).abs() < 1e-12);
    /// assert_eq!(depth(0.0), 0.0);
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn starting_at(self, time: f64) -> Result<Self, WallError> {
        Ok(Self { start: finite("start of a motion", time)?, ..self })
    }

    /// Returns the same part, shifted by a vector.
    ///
    /// If the part turns about a point, that point shifts with it.
    ///
    /// # Errors
    /// If a coordinate would not be finite.
    pub fn shifted(mut self, by: DVec2) -> Result<Self, WallError> {
        for brick in self.bricks.iter_mut().chain(&mut self.corners) {
            *brick = brick.shifted(by)?;
        }
        if let Some(Turning { about, .. }) = &mut self.travel.turning {
            *about = finite_point(*about + by)?;
        }
        Ok(self)
    }

    /// Returns the same part, rotated about a point, counterclockwise by this angle in radians.
    ///
    /// The direction of its motion and the point about which it turns rotate with it.
    ///
    /// # Errors
    /// If an argument or a resulting coordinate is not finite.
    pub fn rotated(mut self, about: DVec2, angle: f64) -> Result<Self, WallError> {
        for brick in self.bricks.iter_mut().chain(&mut self.corners) {
            *brick = brick.rotated(about, angle)?;
        }
        let turn = direction(angle);
        if let Some(Along { direction, .. }) = &mut self.travel.along {
            *direction = unit(turn.rotate(*direction))?;
        }
        if let Some(Turning { about: pivot, .. }) = &mut self.travel.turning {
            *pivot = finite_point(about + turn.rotate(*pivot - about))?;
        }
        Ok(self)
    }
}

impl Part {
    /// Sets a motion of the part along a direction, or returns an error if the part cannot move in this way.
    pub(super) fn moving(self, along: Along) -> Result<Self, WallError> {
        Self { travel: Travel { along: Some(along), ..self.travel }, ..self }.safe()
    }

    /// Returns the motion along a direction, if the part has one.
    pub(in crate::boundary) fn motion_mut(&mut self) -> Option<&mut Motion> {
        self.travel.along.as_mut().map(|along| &mut along.motion)
    }

    /// Changes the motion of a part with a mass by this impulse. Returns whether the part has a mass.
    pub(in crate::boundary) fn take(&mut self, impulse: DVec2, time: f64) -> bool {
        let Some(Along { direction, motion }) = &mut self.travel.along else { return false };
        motion.change(|piston| piston.struck(impulse.dot(*direction), time))
    }

    /// Returns whether disks in this rectangle could rub a part with a mass along its direction.
    pub(in crate::boundary) fn is_pushed_aside(&self, room: &Region) -> bool {
        let Some(Along { direction, motion }) = &self.travel.along else { return false };
        if motion.stroke().is_none() || !self.conduct.response().has_friction() {
            return false;
        }
        let is_reached = |tip: &Brick| {
            let Region { min, max } = self.travel.bounds(tip);
            min.cmplt(room.max).all() && max.cmpgt(room.min).all()
        };
        let holds = |brick: &Brick| brick.is_across(*direction) || brick.is_point() && !is_reached(brick);
        !self.all_bricks().all(holds)
    }

    /// Returns the part, or an error if the part would jump into disks, or has a mass and turns.
    fn safe(self) -> Result<Self, WallError> {
        let (turning, has_mass) = (self.travel.angular_velocity(), self.travel.piston().is_some());
        accept(turning == 0.0 || !has_mass, "angular velocity of a part with a mass", "0", turning)?;
        let Travel { along: Some(Along { direction, motion }), turning } = &self.travel else {
            return Ok(self);
        };
        let faces = turning.is_none() && self.all_bricks().all(|brick| brick.faces(*direction));
        if faces || !motion.jumps() { Ok(self) } else { Err(WallError::Jump) }
    }
}
