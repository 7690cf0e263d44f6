//! What a disk finds at a wall, in a form that can be compared between origins, states and searches.

use glam::DVec2;

use super::trial::{PART, Trial};
use crate::boundary::{Boundary, Response, Surface, Touch};
use crate::collision::laws::hostile_contacts;
use crate::violation::require;
use crate::{Fingerprint, Violation};

/// Largest relative error of a velocity with another time origin.
const SAME: f64 = 1e-9;

/// Number of contacts in which the rule of a wall is compared.
const CONTACTS: usize = 20;

/// Fraction of the radius by which a disk is enlarged, and moved along a wall, for the name of the wall.
const BESIDE: f64 = 1e-3;

/// The surface at a touch, and the response of the wall.
#[derive(Debug)]
pub(super) struct Seen {
    surface: Surface<'static>,
    response: String,
    /// Only rules are compared as text: a temperature that varies with time has a rounding error.
    temperature: f64,
}

impl Seen {
    pub(super) fn of(trial: &Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2) -> Self {
        let surface = trial.boundary.surface(wall, place, time);
        let bare = Surface::new(surface.normal, surface.velocity)
            .with_kind(surface.kind)
            .with_radius(surface.radius)
            .with_mass(surface.mass)
            .with_tangential_mass(surface.tangential_mass);
        let (response, temperature) = match surface.response {
            Response::Thermal(thermal) => {
                (format!("Thermal, slip {}", thermal.slip()), thermal.temperature())
            }
            other => (in_words(&Surface::new(DVec2::Y, DVec2::ZERO).with_response(other), CONTACTS), 1.0),
        };
        Self { surface: bare, response, temperature }
    }

    /// Returns whether both are the same up to the rounding error of late times, which shifts a wall that
    /// moves.
    pub(super) fn agrees(&self, other: &Self, trial: &Trial<'_>) -> bool {
        is_near(self.surface.radius, other.surface.radius, trial) && self.acts_as(other, trial)
    }

    /// Returns whether both are the same except for their radii, as a tip and the side that ends there.
    fn acts_as(&self, other: &Self, trial: &Trial<'_>) -> bool {
        let (one, two, late) = (&self.surface, &other.surface, lateness(trial));
        let slack = SAME * (one.velocity.length() + trial.speed * late);
        one.normal.distance(two.normal) <= 100.0 * SAME * late
            && one.velocity.distance(two.velocity) <= slack
            && is_near(one.mass, two.mass, trial)
            && is_near(one.tangential_mass, two.tangential_mass, trial)
            && one.kind == two.kind
            && self.response == other.response
            && is_near(self.temperature, other.temperature, trial)
    }
}

/// Returns the factor by which rounding errors grow at the present time origin.
fn lateness(trial: &Trial<'_>) -> f64 {
    1.0 + trial.origin * trial.speed / trial.length()
}

fn is_near(one: f64, two: f64, trial: &Trial<'_>) -> bool {
    // The difference of two infinite numbers is NaN.
    one == two || (one - two).abs() <= SAME * lateness(trial) * one.abs().min(two.abs())
}

/// Returns the wall that overlaps name at a touch and on both sides of it. Where two walls meet, there is no
/// such wall.
pub(super) fn name(trial: &Trial<'_>, Touch { wall, time, .. }: Touch, place: DVec2) -> Option<usize> {
    let step = BESIDE * trial.radius;
    let along = step * trial.boundary.surface(wall, place, time).normal.perp();
    let [one, here, other] =
        [place - along, place, place + along].map(|place| Some(trial.depth(place, step, time)?.with));
    here.filter(|_| here == one && here == other)
}

/// Checks that overlaps name the wall of a touch, or another wall with the same surface there, such as the
/// next brick of a corner.
pub(super) fn check_name(trial: &Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Some(named) = name(trial, touch, place).filter(|&named| named != touch.wall) else { return Ok(()) };
    let seen = |wall| Seen::of(trial, Touch::new(touch.time, wall), place);
    let is_same = named < trial.wall_count && seen(named).acts_as(&seen(touch.wall), trial);
    require!(PART, "overlapped wall", is_same;
        "a disk at {place:?} touches wall {} at {:?}, but overlaps wall {named} there", touch.wall, touch.time);
    Ok(())
}

/// Returns all data of a surface as text; a rule is represented by a digest of its impulses in this number of
/// contacts, since the impulses would fill a page.
pub(super) fn in_words(surface: &Surface<'_>, contacts: usize) -> String {
    let Response::Rule(rule) = surface.response else { return format!("{surface:?}") };
    let impulses = hostile_contacts().take(contacts).map(|contact| rule.impulse(&contact));
    let digest = impulses.fold(Fingerprint::of("impulses"), |digest, impulse| {
        digest.number(impulse.normal()).number(impulse.tangential()).number(impulse.couple())
    });
    format!("{surface:?} with impulses of the digest {digest}")
}
