//! Random contacts, over the decades between the hostile contacts.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::Kind;
use crate::collision::Contact;
use crate::random::uniform;

/// Number of random contacts in a check.
const CONTACTS: usize = 12_000;

/// A partner of a collision. A wall has an infinite inertia factor, and mostly an infinite mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Partner {
    pub(crate) mass: f64,
    pub(crate) inertia_factor: f64,
    pub(crate) radius: f64,
    pub(crate) kind: Kind,
}

impl Partner {
    /// Returns a wall of this radius: infinite for a straight one, negative for a hollow one.
    pub(crate) const fn wall(mass: f64, radius: f64, kind: Kind) -> Self {
        Self { mass, inertia_factor: f64::INFINITY, radius, kind }
    }

    const fn compliances(&self) -> [f64; 4] {
        let Self { mass, inertia_factor: factor, radius, .. } = *self;
        if factor == f64::INFINITY {
            return [1.0 / mass, 1.0 / mass, 0.0, 0.0];
        }
        let response = 1.0 / (factor * mass * radius);
        [1.0 / mass, (1.0 + 1.0 / factor) / mass, response, response / radius]
    }
}

/// Returns the contact of two partners that close and slip at these speeds.
pub(crate) fn meeting(partners: [Partner; 2], closing: f64, slip: f64, spin: f64) -> Contact {
    let [one, other] = partners.map(|partner| partner.compliances());
    let [normal, tangential, inertia] = [0, 1, 3].map(|index| 1.0 / (one[index] + other[index]));
    Contact::new(closing, slip, normal, tangential)
        .with_kinds(partners.map(|partner| partner.kind))
        .with_radii(partners.map(|partner| partner.radius))
        .with_spin(spin, inertia, one[2] - other[2])
}

/// Returns contacts between disks, and with straight, convex and hollow walls. They include relative
/// spins, mass ratios of up to 10⁶ and infinite masses. The previous collision of a partner may be at any
/// earlier time.
pub(super) fn random_contacts(seed: u64, kinds: &[Kind]) -> impl Iterator<Item = Contact> + '_ {
    let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(seed));
    (0..CONTACTS).map(move |_| random.contact(kinds))
}

struct Random(Xoshiro256PlusPlus);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        (uniform(&mut self.0) * count as f64) as usize
    }

    /// Returns a number between 10 to the power −`decades` and 10 to the power `decades`.
    fn decades(&mut self, decades: f64) -> f64 {
        libm::exp10(decades * (2.0 * uniform(&mut self.0) - 1.0))
    }

    fn sign(&mut self) -> f64 {
        if self.below(2) == 0 { 1.0 } else { -1.0 }
    }

    /// Returns an ordinary speed, or a speed from a range of a few or of many decades.
    fn speed(&mut self) -> f64 {
        match self.below(3) {
            0 => 10.0 * uniform(&mut self.0),
            1 => self.decades(3.0),
            _ => self.decades(12.0),
        }
    }

    fn slip(&mut self, closing: f64) -> f64 {
        let size = match self.below(8) {
            0 => return 0.0,
            1..=3 => 5.0 * closing * uniform(&mut self.0),
            _ => self.speed(),
        };
        self.sign() * size
    }

    fn size(&mut self) -> f64 {
        match self.below(3) {
            0 => 0.5,
            1 => self.decades(1.0),
            _ => self.decades(6.0),
        }
    }

    fn kind(&mut self, kinds: &[Kind]) -> Kind {
        // Half of the kinds are among the first four, so that all pairs of these meet often.
        let most = kinds.len().min(if self.below(2) == 0 { 4 } else { usize::MAX });
        kinds.get(self.below(most)).copied().unwrap_or_default()
    }

    fn disk(&mut self, mass: f64, kinds: &[Kind]) -> Partner {
        let factors = [0.5, 1.0, 0.5, self.decades(3.0).min(1.0)];
        let inertia_factor = factors[self.below(4)];
        Partner { mass, inertia_factor, radius: self.size(), kind: self.kind(kinds) }
    }

    /// Returns a straight wall, a convex one, or a hollow one around a disk of this radius.
    fn wall(&mut self, mass: f64, radius: f64, kinds: &[Kind]) -> Partner {
        let kind = if self.below(4) == 0 { self.kind(kinds) } else { Kind::WALL };
        let mass = if self.below(4) == 0 { mass } else { f64::INFINITY };
        let radii = [f64::INFINITY, radius * self.decades(2.0), -radius * (1.001 + self.size())];
        Partner::wall(mass, radii[self.below(3)], kind)
    }

    fn contact(&mut self, kinds: &[Kind]) -> Contact {
        let mass = if self.below(3) == 0 { 1.0 } else { self.decades(12.0) };
        let first = self.disk(mass, kinds);
        let ratio = if self.below(3) == 0 { 1.0 } else { self.decades(6.0) };
        let second = match self.below(5) {
            0 | 1 => self.wall(mass * ratio, first.radius, kinds),
            _ => self.disk(mass * ratio, kinds),
        };
        let closing = if self.below(16) == 0 { 0.0 } else { self.speed() };
        let spin = if self.below(4) == 0 { 0.0 } else { self.slip(closing) / first.radius };
        let time = match self.below(4) {
            0 | 1 => f64::INFINITY,
            2 => self.decades(3.0),
            _ => self.decades(12.0),
        };
        let contact = meeting([first, second], closing, self.slip(closing), spin);
        contact.with_time_since_last_collision(time)
    }
}
