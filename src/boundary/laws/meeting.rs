//! A touch of a wall, as the checks pass it on.

use glam::DVec2;

use super::trial::Trial;
use crate::boundary::{Boundary, Response, Surface, Touch};
use crate::collision::laws::hostile_contacts;
use crate::{Fingerprint, Flight};

/// Closing speed below which a touch is grazing, as a fraction of the speeds.
const GRAZING: f64 = 1e-2;

/// Number of contacts in which the rules of a wall are compared.
const CONTACTS: usize = 20;

/// Largest relative difference between surfaces that are seen from two time origins, and between surfaces of
/// two walls at one place.
const SAME: f64 = 1e-9;
const SAME_PLACE: f64 = 1e-6;

/// A touch, and how the disk meets the wall.
pub(super) struct Meeting {
    pub(super) touch: Touch,
    /// Position of the disk.
    pub(super) place: DVec2,
    /// The surface without its response, and the response in words.
    pub(super) surface: Surface<'static>,
    pub(super) response: String,
    /// Speed at which the gap opens; negative while it closes.
    pub(super) rate: f64,
    /// True if the gap hardly closes.
    pub(super) is_grazing: bool,
}

impl Meeting {
    pub(super) fn of(trial: &Trial<'_>, flight: &Flight, touch: Touch) -> Self {
        let (place, moved) = (flight.position(touch.time), flight.velocity(touch.time));
        let Surface { normal, velocity, response, kind, radius, mass, angular_velocity } =
            trial.boundary.surface(touch.wall, place, touch.time);
        let (response, none) = (in_words(response), Response::Shared);
        let surface = Surface { normal, velocity, response: none, kind, radius, mass, angular_velocity };
        let rate = (moved - velocity).dot(normal);
        let slow = GRAZING * (moved.length() + velocity.length());
        Self { touch, place, surface, response, rate, is_grazing: rate.abs() <= slow }
    }

    /// Returns the uncertainty of the time of the touch: the time in which the gap closes by its rounding
    /// error. It is infinite for a grazing touch: rounding decides when it happens, and whether it does.
    pub(super) fn slack(&self, trial: &Trial<'_>) -> f64 {
        if self.is_grazing { f64::INFINITY } else { 4.0 * trial.rounding() / self.rate.abs() }
    }

    /// Returns whether this wall is touched, or another wall with the same surface at this place, as the next
    /// brick of a corner.
    pub(super) fn is_with(&self, trial: &Trial<'_>, other: usize) -> bool {
        let is_alike = |one: &Surface<'_>, two: Surface<'_>| {
            let speeds = one.velocity.length() + trial.speed;
            one.normal.distance(two.normal) <= SAME_PLACE
                && one.velocity.distance(two.velocity) <= SAME_PLACE * speeds
        };
        let surface = || trial.boundary.surface(other, self.place, self.touch.time);
        other == self.touch.wall || other < trial.wall_count && is_alike(&self.surface, surface())
    }

    /// Returns whether the surface of this wall is the same, with times that count from an origin that is
    /// earlier by `shift`. The normal follows from the gap, and so does the radius, but less exactly.
    pub(super) fn is_same_from(&self, trial: &Trial<'_>, shift: f64) -> bool {
        let Self { touch: Touch { wall, time, .. }, place, surface: one, .. } = self;
        let two = trial.boundary.surface(*wall, *place, time + shift);
        // The rounding error of late times shifts a wall that moves.
        let late = SAME * (1.0 + (trial.origin + shift) / trial.crossing());
        let slack = SAME * one.velocity.length() + trial.speed * late;
        // The difference of two infinite numbers is NaN.
        let is_near = |a: f64, b: f64| a == b || (a - b).abs() <= late * a.abs().min(b.abs());
        is_near(one.mass, two.mass)
            && is_near(one.radius, two.radius)
            && one.velocity.distance(two.velocity) <= slack
            && one.kind == two.kind
            && self.response == in_words(two.response)
    }
}

/// Returns the response of a wall as text; a rule is represented by a digest of its impulses in some
/// contacts, since the impulses would fill a page.
fn in_words(response: Response<'_>) -> String {
    let Response::Rule(rule) = response else { return format!("{response:?}") };
    let impulses = hostile_contacts().take(CONTACTS).map(|contact| rule.impulse(&contact));
    let digest = impulses.fold(Fingerprint::of("impulses"), |digest, impulse| {
        digest.number(impulse.normal()).number(impulse.tangential()).number(impulse.couple())
    });
    format!("a rule with impulses of the digest {digest}")
}
