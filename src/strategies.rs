//! Random inputs for property tests of your own rules and walls; the module needs the feature `proptest`.
//!
//! Each function returns a [`Strategy`] that is hostile on purpose: ordinary values, the edges of their
//! ranges, and values over many decades, in mixtures that a run of the simulation might take days to meet.
//! The crate's own tests use the same strategies.
//!
//! The example checks a rule of your own against momentum conservation and the laws of friction:
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

use crate::collision::{Contact, Elastic, collide};
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

/// Returns speeds of either sign: ordinary ones, ones spread over 24 decades, and zero.
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
    let any_angle = (0.0..TAU).prop_map(|angle| {
        let (sine, cosine) = libm::sincos(angle);
        DVec2::new(cosine, sine)
    });
    prop_oneof![
        4 => any_angle,
        1 => prop_oneof![Just(DVec2::X), Just(DVec2::Y), Just(-DVec2::X), Just(-DVec2::Y)],
    ]
}

/// Returns contacts as a rule sees them: they close, and the partners have never collided before.
///
/// The tangential mass is at most the normal one, and can be a thousandth of it. The partners are of the
/// kinds 0 to 2, or one is a wall.
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
    (
        closing_speed(),
        speed(),
        decades(-12.0, 12.0),
        prop_oneof![4 => decades(-3.0, 0.0), 1 => Just(1.0 / 3.0)],
    )
        .prop_flat_map(|(closing, slip, mass, ratio)| {
            let contact = Contact::new(closing, slip, mass, (mass * ratio).min(mass));
            partners().prop_map(move |(kinds, radii)| contact.with_kinds(kinds).with_radii(radii))
        })
}

/// Returns the kinds and radii of two disks, or of a disk and a wall.
fn partners() -> impl Strategy<Value = ([Kind; 2], [f64; 2])> {
    let disk = || ((0..3_u16).prop_map(Kind::new), decades(-6.0, 6.0));
    let other = prop_oneof![3 => disk(), 1 => (Just(Kind::WALL), Just(f64::INFINITY))];
    (disk(), other).prop_map(|(disk, other)| ([disk.0, other.0], [disk.1, other.1]))
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
