//! A boundary.

use granular_edmd::boundary::{
    Boundary, Brick, Domain, FirstTouch, Overlap, Probe, Region, Response, Surface, Touch, WallError,
    WallView,
};
use granular_edmd::collision::CollisionRule;
use granular_edmd::glam::DVec2;
use granular_edmd::{Fingerprint, Flight};

use crate::viscoelastic::Viscoelastic;

/// A circular drum about the origin that turns about its axis.
#[derive(Debug, Clone, Copy)]
pub struct Drum {
    wall: Brick,
    radius: f64,
    angular_velocity: f64,
    rule: Option<Viscoelastic>,
}

impl Drum {
    /// # Errors
    /// If the radius is not finite and positive.
    pub fn new(radius: f64) -> Result<Self, WallError> {
        let wall = Brick::circle(DVec2::ZERO, radius)?;
        Ok(Self { wall, radius, angular_velocity: 0.0, rule: None })
    }

    pub fn turning(self, angular_velocity: f64) -> Self {
        Self { angular_velocity, ..self }
    }

    pub fn with_rule(self, rule: Viscoelastic) -> Self {
        Self { rule: Some(rule), ..self }
    }
}

impl Boundary for Drum {
    fn domain(&self) -> Domain {
        let radius = self.radius;
        Domain::new(-radius, radius, -radius, radius)
    }

    fn wall_count(&self) -> usize {
        1
    }

    fn wall(&self, _wall: usize, _time: f64) -> WallView<'_> {
        WallView::new("drum")
    }

    fn set_time_origin(&mut self, _: f64) {}

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.wall.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.wall.first_touch(flight, until).map(|time| Touch::new(time, 0)).into()
    }

    fn surface(&self, _wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
        let normal = self.wall.normal(position);
        let velocity = -self.angular_velocity * self.radius * normal.perp();
        let response = self.rule.as_ref().map_or(Response::Shared, |rule| Response::Rule(rule));
        let surface = Surface::new(normal, velocity).with_radius(-self.radius).with_response(response);
        surface.with_angular_velocity(self.angular_velocity)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.radius() - self.wall.signed_distance(probe.position());
        (depth > 0.0).then_some(Overlap::new(0, depth))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let drum = Fingerprint::of("Drum").number(self.radius).number(self.angular_velocity);
        match self.rule {
            None => Some(drum),
            Some(rule) => Some(drum.part(rule.fingerprint()?)),
        }
    }
}
