//! Symmetries of mechanics: exchange, mirror, rotation, a moving frame, units, and the ways to hold a rule.

use std::sync::Arc;

use granular_edmd::Disk;
use granular_edmd::collision::{CollisionRule, Encounter, collide};
use granular_edmd::glam::DVec2;
use granular_edmd::strategies::{direction, touching_pair};
use proptest::prelude::*;

use crate::kinematics::{EPSILON, speed_magnitude};
use crate::rules::{Law, config, law};

/// The disk with its vectors mapped by `map` and its angular velocity multiplied by `turn`.
fn mapped(disk: &Disk, map: impl Fn(DVec2) -> DVec2, turn: f64) -> Disk {
    disk.with_position(map(disk.position()))
        .and_then(|new| new.with_velocity(map(disk.velocity())))
        .and_then(|new| new.with_angular_velocity(turn * disk.angular_velocity()))
        .unwrap()
}

fn collided(law: &Law, first: &Disk, second: &Disk) -> (Disk, Disk) {
    let after = collide(&law.rule(), first, second);
    (after.first, after.second)
}

/// Distance of two outcomes, as a speed.
fn distance(left: &Disk, right: &Disk) -> f64 {
    let spin = left.radius() * (left.angular_velocity() - right.angular_velocity());
    (left.velocity() - right.velocity()).length() + spin.abs()
}

/// Vectors of binary fractions, which a sum does not round.
fn binary_fractions() -> impl Strategy<Value = DVec2> {
    let component = (-(1 << 30)..1 << 30).prop_map(|number: i32| f64::from(number) / f64::from(1 << 20));
    (component.clone(), component).prop_map(DVec2::from)
}

/// Returns a power of two. No product with it rounds.
fn unit() -> impl Strategy<Value = f64> {
    (-20..20).prop_map(|exponent| f64::from(exponent).exp2())
}

proptest! {
    #![proptest_config(config())]

    /// First and second are names: the outcome is the same to the last bit.
    #[test]
    fn exchange(law in law(), (first, second) in touching_pair()) {
        let (new_first, new_second) = collided(&law, &first, &second);
        prop_assert_eq!(collided(&law, &second, &first), (new_second, new_first));
    }

    /// A mirror turns every rotation around; a change of sign does not round.
    #[test]
    fn mirror(law in law(), (first, second) in touching_pair()) {
        let mirror = |disk: &Disk| mapped(disk, |vector| DVec2::new(-vector.x, vector.y), -1.0);
        let (new_first, new_second) = collided(&law, &first, &second);
        prop_assert_eq!(collided(&law, &mirror(&first), &mirror(&second)), (mirror(&new_first), mirror(&new_second)));
    }

    /// A quarter turn swaps components, which does not round either.
    #[test]
    fn quarter_turn(law in law(), (first, second) in touching_pair()) {
        let turn = |disk: &Disk| mapped(disk, DVec2::perp, 1.0);
        let (new_first, new_second) = collided(&law, &first, &second);
        prop_assert_eq!(collided(&law, &turn(&first), &turn(&second)), (turn(&new_first), turn(&new_second)));
    }

    /// Any turn rounds the velocities; sliding passes the rounding of the closing speed on to the spin,
    /// multiplied by the friction and the inverse inertia factor. On the edge of sticking the two views may
    /// disagree.
    #[test]
    fn rotation(law in law(), (first, second) in touching_pair(), way in direction()) {
        let turn = |disk: &Disk| mapped(disk, |vector| way.rotate(vector), 1.0);
        let encounter = collide(&law.rule(), &first, &second);
        let Encounter { first: new_first, second: new_second, contact, .. } = encounter;
        let turned = collide(&law.rule(), &turn(&first), &turn(&second));
        prop_assume!(law.sticks(&contact) == law.sticks(&turned.contact));
        let inertia = first.inertia_factor().min(second.inertia_factor());
        let gain = if law.sticks(&contact) { 1.0 } else { 1.0 + law.dynamic_friction / inertia };
        let speeds: f64 = [first, second, new_first, new_second].iter().map(speed_magnitude).sum();
        let apart = distance(&turned.first, &turn(&new_first)) + distance(&turned.second, &turn(&new_second));
        prop_assert!(apart <= 32.0 * EPSILON * speeds * gain, "{apart} of {speeds}");
    }

    /// A moving observer sees the same contact to the last bit, and the same impulse.
    #[test]
    fn moving_frame(
        law in law(),
        (first, second) in touching_pair(),
        velocity in binary_fractions(),
        approach in binary_fractions(),
        frame in binary_fractions(),
    ) {
        let approach = if approach.dot(first.position()) < 0.0 { -approach } else { approach };
        let seen = |disk: &Disk, velocity: DVec2| disk.with_velocity(velocity).unwrap();
        let (rest, moving) = (
            collide(&law.rule(), &seen(&first, velocity), &seen(&second, velocity + approach)),
            collide(&law.rule(), &seen(&first, velocity + frame), &seen(&second, velocity + approach + frame)),
        );
        prop_assert_eq!((rest.contact, rest.impulse), (moving.contact, moving.impulse));
        for (rest, moving) in [(rest.first, moving.first), (rest.second, moving.second)] {
            let expected = rest.velocity() + frame;
            let magnitude = rest.velocity().length() + frame.length() + approach.length();
            prop_assert!((moving.velocity() - expected).length() <= 4.0 * EPSILON * magnitude);
            prop_assert_eq!(rest.angular_velocity(), moving.angular_velocity());
        }
    }

    /// The rule holds no scale of its own: other units of length, time and mass give the same numbers.
    #[test]
    fn units(law in law(), (first, second) in touching_pair(), length in unit(), time in unit(), mass in unit()) {
        let convert = |disk: &Disk| {
            Disk::new(disk.position() * length, disk.radius() * length)
                .and_then(|new| new.with_velocity(disk.velocity() * (length / time)))
                .and_then(|new| new.with_angular_velocity(disk.angular_velocity() / time))
                .and_then(|new| new.with_mass(disk.mass() * mass))
                .and_then(|new| new.with_inertia_factor(disk.inertia_factor()))
                .unwrap()
        };
        let (new_first, new_second) = collided(&law, &first, &second);
        let converted = collided(&law, &convert(&first), &convert(&second));
        prop_assert_eq!(converted, (convert(&new_first), convert(&new_second)));
    }

    /// A rule is the same by value, by reference, boxed and shared, and answers alike every time.
    #[test]
    fn ways_to_hold_a_rule(law in law(), contact in granular_edmd::strategies::contact()) {
        let boxed: Box<dyn CollisionRule> = law.rule();
        let impulse = boxed.impulse(&contact);
        let shared: Arc<dyn CollisionRule> = Arc::from(law.rule());
        prop_assert_eq!(boxed.impulse(&contact), impulse);
        prop_assert_eq!(CollisionRule::impulse(&&*boxed, &contact), impulse);
        prop_assert_eq!(CollisionRule::impulse(&&boxed, &contact), impulse);
        prop_assert_eq!(CollisionRule::impulse(&shared, &contact), impulse);
    }

    /// The library's rule is the paper's formula, written down twice.
    #[test]
    fn the_formula(law in law(), contact in granular_edmd::strategies::contact()) {
        // A contact-duration model replaces the formula soon after a collision.
        let contact = contact.with_time_since_last_collision(f64::INFINITY);
        let (impulse, expected) = (law.rule().impulse(&contact), law.expected(&contact));
        prop_assert!((impulse.normal() - expected.normal()).abs() <= 4.0 * EPSILON * expected.normal());
        let tolerance = 8.0 * EPSILON * expected.tangential().abs();
        prop_assert!((impulse.tangential() - expected.tangential()).abs() <= tolerance);
    }
}
