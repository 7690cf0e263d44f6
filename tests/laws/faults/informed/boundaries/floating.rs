//! A round peg that floats through a periodic box, and forgets that blows move its flanks.

use granular_edmd::boundary::{
    Boundary, Brick, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Response, Surface, Touch,
};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::{Flight, ParameterError};

use super::Boundaries;
use crate::faults::blind::boundaries::Walled;

const SIZE: f64 = 10.0;
const RADIUS: f64 = 1.2;
const MASS: f64 = 5.0;

/// Images in which a disk may meet the peg on one flight.
const IMAGES: i32 = 2;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    /// No fault: blows along the surface are zero.
    Smooth,
    Guided,
    OneFlank,
    HeavyFlanks,
}

pub(super) fn plant(boundaries: &mut Boundaries) {
    let all = [
        (Fault::Guided, "a peg that floats is guided along its surface"),
        (Fault::OneFlank, "a peg that floats is guided along its right side"),
        (Fault::HeavyFlanks, "a peg that floats is twice as heavy along its surface"),
    ];
    boundaries.family = "flanks";
    for (fault, name) in all {
        boundaries.plant(name, peg(fault));
    }
}

/// Pegs that forget nothing.
pub(super) fn honest(boundaries: &mut Boundaries) {
    boundaries.plant("a peg that floats", peg(Fault::None));
    boundaries.plant("a smooth peg that floats", peg(Fault::Smooth));
}

fn peg(fault: Fault) -> Walled {
    let rim = Brick::circle(DVec2::ZERO, RADIUS).expect("a radius").reversed();
    let (place, velocity) = (DVec2::new(2.0, 6.0), DVec2::new(0.3, -0.2));
    let boundary = Box::new(Floating { rim, place, velocity, origin: 0.0, fault });
    Walled { boundary, radius: 0.5, gravity: 1.0 }
}

struct Floating {
    rim: Brick,
    /// Position at the origin, of one of the images.
    place: DVec2,
    velocity: DVec2,
    origin: f64,
    fault: Fault,
}

impl Floating {
    fn place(&self, time: f64) -> DVec2 {
        self.place + self.velocity * time
    }

    /// Returns the vector from the nearest image to a position.
    fn offset(&self, position: DVec2, time: f64) -> DVec2 {
        let way = position - self.place(time);
        way - SIZE * (way / SIZE).round()
    }

    fn masses(&self, normal: DVec2) -> [f64; 2] {
        let across = match self.fault {
            Fault::None => MASS,
            Fault::OneFlank if normal.x < 0.0 => MASS,
            Fault::HeavyFlanks => 2.0 * MASS,
            _ => f64::INFINITY,
        };
        [MASS, across]
    }
}

impl Boundary for Floating {
    fn domain(&self) -> Domain {
        Domain::new(0.0, SIZE, 0.0, SIZE).with_periodic_sides().with_periodic_ends()
    }

    fn wall_count(&self) -> usize {
        1
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.place = self.place(origin - self.origin).rem_euclid(DVec2::splat(SIZE));
        self.origin = origin;
    }

    fn may_touch(&self, _: &Region, _: f64) -> bool {
        true
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let start = flight.time();
        let (way, velocity) =
            (self.offset(flight.position(start), start), flight.velocity(start) - self.velocity);
        let images =
            (-IMAGES..=IMAGES).flat_map(|x| (-IMAGES..=IMAGES).map(move |y| DVec2::new(x.into(), y.into())));
        let touch = |image: DVec2| {
            let moved =
                Flight::new(start, way - SIZE * image, velocity, flight.acceleration(), flight.radius());
            self.rim.first_touch(&moved.with_kind(flight.kind()), until)
        };
        images.filter_map(touch).min_by(f64::total_cmp).map(|time| Touch::new(time, 0)).into()
    }

    fn surface(&self, _: usize, position: DVec2, time: f64) -> Surface<'_> {
        let normal = self.rim.normal(self.offset(position, time));
        let [mass, across] = self.masses(normal);
        let surface = Surface::new(normal, self.velocity).with_radius(RADIUS).with_mass(mass);
        match self.fault {
            Fault::Smooth => surface.with_response(Response::Rule(&Elastic)),
            _ => surface.with_tangential_mass(across),
        }
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let distance = self.rim.signed_distance(self.offset(probe.position(), probe.time()));
        Some(Overlap::new(0, probe.radius() - distance)).filter(|overlap| overlap.depth > 0.0)
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        let normal = self.offset(impact.point, impact.time).normalize();
        let ([mass, across], tangent) = (self.masses(normal), normal.perp());
        let along = impact.impulse.dot(tangent) + impact.couple / RADIUS;
        let gain = normal * (impact.impulse.dot(normal) / mass) + tangent * (along / across);
        self.place -= gain * impact.time;
        self.velocity += gain;
        Reaction::Moved
    }

    fn state(&self) -> Vec<f64> {
        [self.place, self.velocity].map(|part| part.to_array()).concat()
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[x, y, along, up] = state else {
            return Err(ParameterError::new("state of the peg", "four numbers", state.len() as f64));
        };
        (self.place, self.velocity) = (DVec2::new(x, y), DVec2::new(along, up));
        Ok(())
    }
}
