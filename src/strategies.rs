//! Random contacts and disks for property tests of custom rules; the module needs the feature `proptest`.
//!
//! Each function returns a [`Strategy`] that is hostile on purpose: ordinary values, the edges of their
//! ranges, and values over many decades, in mixtures that a run of the simulation might take days to meet.
//! The crate's own tests use the same strategies.
//!
//! The example checks a custom rule against momentum conservation and the laws of friction:
//! ```
//! use granular_edmd::collision::{Contact, Friction, collide, from_fn, laws};
//! use granular_edmd::strategies;
//! use proptest::prelude::*;
//!
//! proptest! {
//! #   #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
//!     # /*
//!     #[test]
//!     # */
//!     fn my_rule_is_lawful((first, second) in strategies::touching_pair()) {
//!         let friction = Friction::from_inelasticity(0.5, 0.3).unwrap();
//!         let rule = from_fn(|contact: &Contact| {
//!             let restitution = 1.0 / (1.0 + contact.closing_speed().sqrt());
//!             friction.impulse(contact, contact.normal_impulse(restitution))
//!         });
//!         let encounter = collide(&rule, &first, &second);
//!         let promises = laws::Promises::new().with_friction(0.3);
//!         prop_assert_eq!(promises.check(&encounter.contact, encounter.impulse), Ok(()));
//!
//!         let before = first.mass() * first.velocity() + second.mass() * second.velocity();
//!         let after = first.mass() * encounter.first.velocity()
//!             + second.mass() * encounter.second.velocity();
//!         let size = first.mass() * (first.velocity().length() + encounter.first.velocity().length())
//!             + second.mass() * (second.velocity().length() + encounter.second.velocity().length());
//!         prop_assert!((after - before).length() <= 1e-14 * size);
//!     }
//! }
//! # my_rule_is_lawful();
//! ```

use std::f64::consts::TAU;

use glam::DVec2;
use proptest::prelude::*;

use crate::boundary;
use crate::collision::{Contact, Elastic, collide};
use crate::collision::{Material, meeting};
use crate::{Disk, Kind};

/// Returns positive numbers, spread evenly over the decades from 10 to the power `low` to 10 to the power
/// `high`.
///
/// ```
/// use granular_edmd::strategies::decades;
/// use proptest::prelude::*;
///
/// proptest!(|(mass in decades(-3.0, 3.0))| prop_assert!((0.000_9..1001.0).contains(&mass)));
/// ```
pub fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..=high).prop_map(libm::exp10)
}

/// Returns speeds of either sign: ordinary speeds, speeds spread over 24 decades, and zero.
///
/// ```
/// use proptest::prelude::*;
/// proptest!(|(speed in granular_edmd::strategies::speed())| prop_assert!(speed.abs() < 1e13));
/// ```
pub fn speed() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -3.0..3.0,
        4 => (decades(-12.0, 12.0), any::<bool>()).prop_map(|(size, sign)| if sign { size } else { -size }),
        1 => Just(0.0),
    ]
}

/// Returns unit vectors: at any angle, and along the axes, where components vanish.
///
/// ```
/// use proptest::prelude::*;
/// proptest!(|(normal in granular_edmd::strategies::direction())| prop_assert!(normal.is_normalized()));
/// ```
pub fn direction() -> impl Strategy<Value = DVec2> {
    prop_oneof![
        4 => (0.0..TAU).prop_map(boundary::direction),
        1 => prop_oneof![Just(DVec2::X), Just(DVec2::Y), Just(-DVec2::X), Just(-DVec2::Y)],
    ]
}

/// Returns contacts for rules: closing ones with any slip and relative spin, at any time after the last
/// collision or without an earlier collision.
///
/// The partners are disks of the kinds 0 to 3 with any masses and inertia, or one is a straight, convex or
/// hollow wall. [`contact_of`] takes other kinds.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Elastic, laws};
/// use granular_edmd::strategies;
/// use proptest::prelude::*;
///
/// proptest!(|(contact in strategies::contact())| {
///     prop_assert!(contact.closing_speed() > 0.0);
///     prop_assert!(contact.tangential_mass() <= contact.normal_mass());
///     prop_assert_eq!(laws::check_impulse(&contact, Elastic.impulse(&contact)), Ok(()));
/// });
/// ```
pub fn contact() -> impl Strategy<Value = Contact> {
    contact_of((0..4).map(Kind::new).collect())
}

/// Returns contacts as [`contact`] does, between disks of these kinds and walls.
///
/// # Panics
/// If there are no kinds.
///
/// ```
/// use granular_edmd::{Kind, strategies};
/// use proptest::prelude::*;
///
/// let sand = Kind::new(40);
/// proptest!(|(contact in strategies::contact_of(vec![sand]))| prop_assert_eq!(contact.kinds()[0], sand));
/// ```
pub fn contact_of(kinds: Vec<Kind>) -> impl Strategy<Value = Contact> {
    let spin = prop_oneof![1 => Just(0.0), 2 => speed()];
    let time = prop_oneof![1 => Just(f64::INFINITY), 1 => decades(-12.0, 3.0), 1 => 0.0..1.0];
    (closing_speed(), speed(), spin, time, partners(kinds)).prop_map(
        |(closing, slip, spin, time, partners)| {
            let contact = meeting(partners.each_ref(), closing, slip, spin / partners[0].radius);
            contact.with_time_since_last_collision(time)
        },
    )
}

/// Returns two disks, or a disk and a wall.
fn partners(kinds: Vec<Kind>) -> impl Strategy<Value = [Material; 2]> {
    let factor = prop_oneof![4 => decades(-3.0, 0.0), 1 => Just(0.5)];
    let factor = factor.prop_map(|factor: f64| factor.min(1.0));
    let kind = prop::sample::select(kinds);
    let disk = (decades(-12.0, 12.0), factor, decades(-6.0, 6.0), kind)
        .prop_map(|(mass, inertia_factor, radius, kind)| Disk::at_rest(radius, mass, inertia_factor, kind))
        .boxed();
    let ratio = prop_oneof![1 => Just(1.0), 3 => decades(-6.0, 6.0)];
    (disk.clone(), disk, ratio, 0..6_u8).prop_map(|(first, second, ratio, choice)| {
        let wall = |radius| Material::of_wall(Kind::WALL, radius, f64::INFINITY);
        let other = match choice {
            0 => wall(f64::INFINITY),
            1 => wall(second.radius()),
            2 => wall(-1.05 * first.radius() - second.radius()),
            _ => {
                let (mass, factor) = (first.mass() * ratio, second.inertia_factor());
                Material::of(&Disk::at_rest(second.radius(), mass, factor, second.kind()))
            }
        };
        [Material::of(&first), other]
    })
}

fn closing_speed() -> impl Strategy<Value = f64> {
    prop_oneof![0.1..3.0, decades(-12.0, 12.0)]
}

/// Returns disks at the origin with their centers at rest, of any size, mass and inertia, with or without
/// rotation.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use proptest::prelude::*;
///
/// proptest!(|(disk in granular_edmd::strategies::disk(), x in -9.0..9.0)| {
///     let there = disk.with_position(DVec2::new(x, 0.0)).unwrap();
///     prop_assert_eq!(there.radius(), disk.radius());
/// });
/// ```
pub fn disk() -> impl Strategy<Value = Disk> {
    let inertia_factor = prop_oneof![Just(Disk::HOMOGENEOUS_INERTIA_FACTOR), Just(1.0), decades(-3.0, 0.0)];
    let one_or = |low, high| prop_oneof![1 => Just(1.0), 2 => decades(low, high)];
    (one_or(-6.0, 6.0), one_or(-12.0, 12.0), inertia_factor, speed()).prop_filter_map(
        "within the bounds of a disk",
        |(radius, mass, factor, surface_speed)| {
            let disk = Disk::new(DVec2::ZERO, radius).ok()?.with_mass(mass).ok()?;
            disk.with_inertia_factor(factor.min(1.0)).ok()?.with_angular_velocity(surface_speed / radius).ok()
        },
    )
}

/// Returns two disks that touch and approach, of any sizes, masses and inertia.
///
/// The second disk is at the origin.
///
/// ```
/// use granular_edmd::collision::{Elastic, collide};
/// use granular_edmd::strategies;
/// use proptest::prelude::*;
///
/// proptest!(|((first, second) in strategies::touching_pair())| {
///     let distance = first.position().distance(second.position());
///     prop_assert!((distance / (first.radius() + second.radius()) - 1.0).abs() < 1e-14);
///     prop_assert!(collide(&Elastic, &first, &second).contact.closing_speed() > 0.0);
/// });
/// ```
pub fn touching_pair() -> impl Strategy<Value = (Disk, Disk)> {
    (disk(), disk(), direction(), (speed(), speed()), closing_speed(), speed()).prop_filter_map(
        "still approaching after rounding",
        |(first, second, normal, velocity, closing, slip)| {
            let velocity = DVec2::from(velocity);
            let approach = normal * closing + normal.perp() * slip;
            let first = first.with_position(normal * (first.radius() + second.radius())).ok()?;
            let pair = (first.with_velocity(velocity - approach).ok()?, second.with_velocity(velocity).ok()?);
            (collide(&Elastic, &pair.0, &pair.1).contact.closing_speed() > 0.0).then_some(pair)
        },
    )
}

/// Returns a disk that closes onto a moving or resting wall: the disk, the unit vector from the wall to it,
/// and the wall's velocity, as [`collide_with_wall`](crate::collision::collide_with_wall) takes them.
///
/// ```
/// use granular_edmd::collision::{Elastic, collide_with_wall, laws};
/// use granular_edmd::strategies;
/// use proptest::prelude::*;
///
/// proptest!(|((disk, normal, velocity) in strategies::disk_closing_on_wall())| {
///     let encounter = collide_with_wall(&Elastic, &disk, normal, velocity);
///     prop_assert!(encounter.contact.closing_speed() > 0.0);
///     prop_assert_eq!(laws::check_impulse(&encounter.contact, encounter.impulse), Ok(()));
/// });
/// ```
pub fn disk_closing_on_wall() -> impl Strategy<Value = (Disk, DVec2, DVec2)> {
    touching_pair().prop_map(|(disk, wall)| (disk, disk.position().normalize(), wall.velocity()))
}
