//! A boundary.

use std::borrow::Cow;

use granular_edmd::boundary::{Boundary, Domain, Region, Response, Surface, Touch};
use granular_edmd::collision::CollisionRule;
use granular_edmd::glam::DVec2;
use granular_edmd::roots::first_descent_of_quartic;
use granular_edmd::{Fingerprint, Flight};

use crate::viscoelastic::Viscoelastic;

/// A circular drum about the origin that turns about its axis.
#[derive(Debug, Clone, Copy)]
pub struct Drum {
    radius: f64,
    angular_velocity: f64,
    rule: Option<Viscoelastic>,
}

impl Drum {
    pub fn new(radius: f64) -> Self {
        Self { radius, angular_velocity: 0.0, rule: None }
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

    fn wall_name(&self, _wall: usize) -> Cow<'_, str> {
        Cow::Borrowed("drum")
    }

    fn set_time_origin(&mut self, _: f64) {}

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        let farthest = region.min.abs().max(region.max.abs());
        farthest.length() + radius >= self.radius
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch> {
        let start = flight.time();
        let (r, v, a) = (flight.position(start), flight.velocity(start), flight.acceleration());
        let free = self.radius - flight.radius();
        // The square of the remaining radius, as a polynomial of the time.
        let gap = [
            (free - r.length()) * (free + r.length()),
            -2.0 * r.dot(v),
            -(v.length_squared() + r.dot(a)),
            -v.dot(a),
            -0.25 * a.length_squared(),
        ];
        let wait = first_descent_of_quartic(&gap, until - start)?;
        Some(Touch::new((start + wait).min(until), 0))
    }

    fn surface(&self, _wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
        let outward = position.normalize_or(DVec2::Y);
        let velocity = self.angular_velocity * self.radius * outward.perp();
        let response = self.rule.as_ref().map_or(Response::Shared, |rule| Response::Rule(rule));
        Surface::new(-outward, velocity).with_response(response)
    }

    fn overlap(&self, position: DVec2, radius: f64, _time: f64) -> Option<(usize, f64)> {
        let depth = position.length() + radius - self.radius;
        (depth > 0.0).then_some((0, depth))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let drum = Fingerprint::of("Drum").number(self.radius).number(self.angular_velocity);
        match self.rule {
            None => Some(drum),
            Some(rule) => Some(drum.part(rule.fingerprint()?)),
        }
    }
}
