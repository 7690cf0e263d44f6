//! Contacts that a rule can meet: from mild to extreme, and random ones over the decades between.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::collision::{Contact, Material, meeting};
use crate::random::uniform;
use crate::{Disk, Kind};

// Each list begins with its mildest values, so that a faulty rule fails first at ordinary numbers.

/// Closing and slip speeds of mild contacts.
const MILD_SPEEDS: [(f64, f64); 9] = [
    (1.0, 0.0),
    (1.0, 0.5),
    (1.0, -0.5),
    (2.0, 0.0),
    (0.5, 0.0),
    (1.0, 2.0),
    (1.0, -2.0),
    (0.5, 5.0),
    (0.5, -5.0),
];

/// Closing speeds: ordinary ones, zero, and decades between almost zero and the largest speed of a disk.
const CLOSING_SPEEDS: [f64; 14] =
    [1.0, 0.1, 3.0, 0.0, 1e-3, 1e3, 1e-6, 1e6, 1e-12, 1e12, 1e-30, 1e-60, 1e60, 1e-300];

/// Slip speeds relative to the closing speed: zero, near the limit of sticking, small (central contacts), and
/// large (grazing contacts).
const SLIP_RATIOS: [f64; 12] = [0.0, 1.0, 0.3, 3.0, 0.1, 10.0, 1e-3, 1e3, 1e-9, 1e9, 1e-15, 1e15];

/// Slip speeds that do not depend on the closing speed.
const SLIP_SPEEDS: [f64; 4] = [1.0, 1e-6, 1e-30, 1e60];

/// Reduced masses: from two disks of mass 1 to the lightest and the heaviest disks.
const MASSES: [f64; 5] = [0.5, 1e-3, 1e3, 1e-30, 1e30];

/// Tangential masses relative to the normal one: a homogeneous disk, a ring, the bound, and all mass near the
/// center.
const MASS_RATIOS: [f64; 4] = [1.0 / 3.0, 0.5, 1.0, 1e-6];

/// Times since the last collision: infinite, short, zero, and very short.
const TIMES: [f64; 4] = [f64::INFINITY, 1e-3, 0.0, 1e-9];

/// Partners: two disks, or a disk and a wall, equal or as different as possible. The first three are mild.
const PARTNERS: [([Kind; 2], [f64; 2]); 7] = [
    ([Kind::DEFAULT; 2], [0.5; 2]),
    ([Kind::DEFAULT, Kind::WALL], [0.5, f64::INFINITY]),
    ([Kind::new(1), Kind::DEFAULT], [0.1, 1.0]),
    ([Kind::DEFAULT, Kind::new(1)], [1e-30, 1e30]),
    ([Kind::new(1), Kind::new(1)], [1e30; 2]),
    ([Kind::DEFAULT, Kind::WALL], [1e30, f64::INFINITY]),
    ([Kind::new(1), Kind::WALL], [1e-30, f64::INFINITY]),
];

/// Returns contacts that authors of rules tend to forget, the same ones in the same order every time.
///
/// The contacts cover closing and slip speeds, masses and mass ratios over all decades that the engine
/// accepts. Among them are positive, negative and zero slips, central and grazing contacts, contacts without
/// closing speed, and partners that have just collided. The partners are, alternately, disks of kinds 0 and 1
/// and straight walls, with radii up to the extremes that the engine accepts.
///
/// Mild contacts come first, such as two disks of mass 1 that meet at speed 1, so the error of a rule that
/// fails at one of them shows numbers that are easy to read.
///
/// ```
/// use granular_edmd::collision::laws::hostile_contacts;
/// assert!(hostile_contacts().take(100).all(|contact| contact.closing_speed() <= 2.0));
/// assert!(hostile_contacts().any(|contact| contact.closing_speed() == 0.0));
/// assert!(hostile_contacts().any(|contact| contact.slip_speed().abs() > 1e9 * contact.closing_speed()));
/// assert!(hostile_contacts().all(|contact| contact.tangential_mass() <= contact.normal_mass()));
/// ```
pub fn hostile_contacts() -> impl Iterator<Item = Contact> {
    mild_contacts().chain(extreme_contacts())
}

/// Returns contacts of ordinary speeds with mild partners only. The extreme contacts cycle through the
/// partners, so each pair of partners, mild or not, meets all speeds and masses.
///
/// The disks are rings of mass 1: their tangential mass, 0.25, is easier to read than one sixth.
fn mild_contacts() -> impl Iterator<Item = Contact> {
    MILD_SPEEDS.into_iter().flat_map(|(closing, slip)| {
        let contact = Contact::new(closing, slip, 0.5, 0.25);
        PARTNERS.into_iter().take(3).map(move |partners| between(contact, partners))
    })
}

/// Returns ordinary contacts of each kind with the same kind, the default kind and a wall, of a disk of the
/// default kind with a wall of this kind and, for kinds below 256, of this kind with all smaller kinds. Each
/// pair meets without slip, too: the loss of a slip could hide a gain along the normal.
pub(super) fn contacts_of_all_kinds() -> impl Iterator<Item = Contact> {
    [0.0, 0.5].into_iter().flat_map(|slip| contacts_of_kinds_with(Contact::new(1.0, slip, 0.5, 0.25)))
}

fn contacts_of_kinds_with(contact: Contact) -> impl Iterator<Item = Contact> {
    (0..=u16::MAX).flat_map(move |number| {
        let kind = Kind::new(number);
        let partners = [(kind, 0.5), (Kind::DEFAULT, 0.5), (Kind::WALL, f64::INFINITY)];
        let smaller = 1..if number < 256 { number } else { 1 };
        let partners = partners.into_iter().chain(smaller.map(|number| (Kind::new(number), 0.5)));
        let disks = partners.map(move |(partner, radius)| ([kind, partner], [0.5, radius]));
        let wall = ([Kind::DEFAULT, kind], [0.5, f64::INFINITY]);
        disks.chain([wall]).map(move |partners| between(contact, partners))
    })
}

fn extreme_contacts() -> impl Iterator<Item = Contact> {
    let contacts = speeds().flat_map(|(closing, slip)| {
        masses().flat_map(move |(normal, tangential)| {
            let contact = Contact::new(closing, slip, normal, tangential);
            TIMES.into_iter().map(move |time| contact.with_time_since_last_collision(time))
        })
    });
    // The number of partners has no factor in common with the numbers of masses and times, so each pair of
    // partners meets all masses and all times.
    contacts.zip(PARTNERS.into_iter().cycle()).map(|(contact, partners)| between(contact, partners))
}

fn between(contact: Contact, (kinds, radii): ([Kind; 2], [f64; 2])) -> Contact {
    contact.with_kinds(kinds).with_radii(radii)
}

fn speeds() -> impl Iterator<Item = (f64, f64)> {
    CLOSING_SPEEDS.into_iter().flat_map(|closing| {
        let slips = SLIP_RATIOS.into_iter().map(move |ratio| ratio * closing).chain(SLIP_SPEEDS);
        slips.flat_map(move |slip| [(closing, slip), (closing, -slip)])
    })
}

fn masses() -> impl Iterator<Item = (f64, f64)> {
    MASSES.into_iter().flat_map(|mass| MASS_RATIOS.into_iter().map(move |ratio| (mass, mass * ratio)))
}

/// Number of random contacts in a check.
const CONTACTS: usize = 12_000;

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
        [size, -size][self.below(2)]
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

    fn disk(&mut self, mass: f64, kinds: &[Kind]) -> Material {
        let factors = [0.5, 1.0, 0.5, self.decades(3.0).min(1.0)];
        let inertia_factor = factors[self.below(4)];
        let radius = self.size();
        Material::of(&Disk::at_rest(radius, mass, inertia_factor, self.kind(kinds)))
    }

    /// Returns a straight wall, a convex one, or a hollow one around a disk of this radius.
    fn wall(&mut self, mass: f64, radius: f64, kinds: &[Kind]) -> Material {
        let kind = if self.below(4) == 0 { self.kind(kinds) } else { Kind::WALL };
        let mass = if self.below(4) == 0 { mass } else { f64::INFINITY };
        let radii = [f64::INFINITY, radius * self.decades(2.0), -radius * (1.001 + self.size())];
        Material::of_wall(kind, radii[self.below(3)], mass)
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
        let contact = meeting([&first, &second], closing, self.slip(closing), spin);
        contact.with_time_since_last_collision(time)
    }
}
