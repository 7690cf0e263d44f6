//! The diagnosis of a run that hardly progresses: the disk, its partner, and a remedy. `state/guard.rs`
//! decides when a run hardly progresses, and has the defaults.

use super::engine::Engine;
use super::resolution::{resolve_pair, resolve_wall};
use super::state::{Clock, Exit, Forecast, Standstill, least_progress};
use super::{Remedy, RunError, Simulation};
use crate::boundary::{Boundary, Response};
use crate::collision::{CollisionRule, Contact, Impulse, Regime};
use crate::observable::Partner;
use crate::scheduler::EventScheduler;

/// Smallest closing speed, relative to the speed of a typical disk, at which the diagnosis tries the rule.
const SLOW: f64 = 1e-9;

/// Number of windows in which a run without losses may hardly advance.
const PATIENCE: u32 = 64;

/// Number of consecutive equal windows after which a run without losses is stuck.
const STUCK: u32 = 2;

/// Time, relative to an epoch, over which the reported velocity of a wall is compared with the mean velocity
/// of its surface.
const MOMENT: f64 = 1e-6;

/// Largest relative difference of these velocities that counts as rounding.
const ALIKE: f64 = 1e-3;

/// Share of the energy, or of the closing speed, that is rounding.
const ROUNDING: f64 = 1e-12;

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Returns the error of a run in which time hardly advances before an event of this disk, or `None` if
    /// the run gets more time.
    ///
    /// Many lossless collisions in a short time may end by themselves, as for a light disk between a wall and
    /// a heavy disk that comes near. Such a run gets more time, as long as its windows differ. If the windows
    /// are alike, a disk is squeezed.
    #[cold]
    pub(super) fn stalled(&self, standstill: &Standstill, disk: usize, due: f64) -> Option<RunError> {
        let (disk, due) = self.engine.next_collider(disk, due);
        let partner = self.engine.partner_of(disk);
        let remedy = partner.map_or(Remedy::OtherParts, |partner| self.remedy(disk, partner, due));
        let is_stuck = self.engine.clock.guard.alike >= STUCK || self.engine.clock.guard.slow >= PATIENCE;
        if remedy == Remedy::FasterDisks && !is_stuck {
            return None;
        }
        let wall = partner.and_then(|partner| self.name_of(partner));
        let Standstill { events, elapsed } = *standstill;
        let is_default_met =
            elapsed >= least_progress(self.engine.clock.epoch_length, self.len()) * events as f64;
        let remedy = if is_default_met { Remedy::LessProgress } else { remedy };
        Some(RunError::Stalled { time: self.time(), disk, partner, wall, events, elapsed, remedy })
    }

    fn remedy(&self, disk: usize, partner: Partner, due: f64) -> Remedy {
        let clock = Clock { now: due, ..self.engine.clock };
        match partner {
            Partner::Disk(other) => {
                let periods = self.engine.cells.grid.periods;
                let (collision, _) =
                    resolve_pair(&self.engine.bodies, &self.parts.rule, periods, &clock, disk, other);
                self.engine.remedy_for(&collision.contact, &self.parts.rule)
            }
            Partner::Wall(wall) => {
                let surface = self.parts.boundary.surface(wall, self.engine.bodies.position(disk, due), due);
                if self.moves_otherwise(disk, wall, due) {
                    return Remedy::WallVelocity;
                }
                if self.engine.stopped.is_some_and(|(stopped, _)| stopped == wall) {
                    return Remedy::WallOnStop;
                }
                let (collision, _) =
                    resolve_wall(&self.engine, &self.parts.rule, &surface, &clock, disk, wall);
                match surface.response {
                    Response::Rule(own) => self.engine.remedy_for(&collision.contact, own),
                    Response::Thermal(_) | Response::Absorbing => Remedy::FasterDisks,
                    Response::Shared => self.engine.remedy_for(&collision.contact, &self.parts.rule),
                }
            }
        }
    }

    /// Returns whether a wall's geometry approaches a disk at another speed than the wall's surface reports.
    ///
    /// If the disk is enlarged and held at rest, the depth of its overlap grows at the speed of the wall.
    fn moves_otherwise(&self, disk: usize, wall: usize, due: f64) -> bool {
        let surface = self.parts.boundary.surface(wall, self.engine.bodies.position(disk, due), due);
        let probe = self.engine.probe(disk).with_position(self.engine.bodies.position(disk, due));
        let larger = probe.with_radius(1.01 * probe.radius());
        let depth = |time: f64| {
            self.parts.boundary.overlap(&larger.with_time(time)).filter(|found| found.with == wall)
        };
        let wait = MOMENT * self.engine.clock.epoch_length;
        let (Some(before), Some(after)) = (depth(due), depth(due + wait)) else { return false };
        let (speed, told) = ((after.depth - before.depth) / wait, surface.velocity.dot(surface.normal));
        let typical = self.engine.bodies.typical_diameter / self.engine.clock.epoch_length;
        (speed - told).abs() > ALIKE * (speed.abs() + told.abs() + typical)
    }
}

impl Engine {
    /// Returns the disk of the next collision and its time offset, or the arguments if there is no collision.
    fn next_collider(&self, disk: usize, due: f64) -> (usize, f64) {
        if self.partner_of(disk).is_some() {
            return (disk, due);
        }
        let colliders = (0..self.bodies.len()).filter(|&disk| self.partner_of(disk).is_some());
        let due_of = |disk: usize| (disk, self.bodies.forecast(disk).map_or(f64::INFINITY, Forecast::due));
        colliders.map(due_of).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((disk, due))
    }

    /// Returns the partner of a disk in its next event, if that is a collision.
    fn partner_of(&self, disk: usize) -> Option<Partner> {
        let forecast = self.bodies.forecast(disk)?;
        if forecast.is_collision() {
            let partner = forecast.partner as usize;
            return (partner < self.bodies.len()).then_some(Partner::Disk(partner));
        }
        let wall = usize::from(forecast.wall);
        (forecast.exit == Exit::Wall && wall < self.wall_count).then_some(Partner::Wall(wall))
    }

    /// Returns the remedy that fits the rule's impulse in the same contact at a lower speed.
    fn remedy_for(&self, contact: &Contact, rule: &dyn CollisionRule) -> Remedy {
        let typical = self.bodies.typical_diameter / self.clock.epoch_length;
        // The speed is halved, because disks may bounce exactly at the limiting speed of a remedy, where
        // rounding decides whether it applies. It has a lower bound, because the speed of a disk at rest is
        // only a rounding error.
        let closing = (0.5 * contact.closing_speed()).max(SLOW * typical);
        let slow = Contact::new(closing, 0.0, contact.normal_mass(), contact.tangential_mass())
            .with_time_since_last_collision(contact.time_since_last_collision())
            .with_kinds(contact.kinds())
            .with_radii(contact.radii());
        let impulse = rule.impulse(&slow);
        let fast = rule.impulse(contact);
        let gains = |impulse: Impulse, contact: &Contact| {
            impulse.regime() != Regime::LeastRebound
                && impulse.energy_change(contact) > ROUNDING * contact.available_energy()
        };
        if impulse.closing_speed_after(&slow) > ROUNDING * closing {
            Remedy::PushApart
        } else if gains(impulse, &slow) || gains(fast, contact) {
            Remedy::EnergyGain
        } else if impulse.energy_change(&slow) < -ROUNDING * slow.available_energy() {
            Remedy::ElasticWhenSlow
        } else if impulse.regime() == Regime::ContactDuration {
            Remedy::LongerContactDuration
        } else {
            Remedy::FasterDisks
        }
    }
}
