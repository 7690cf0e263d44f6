//! Momentum and angular momentum, which an impulse at the contact point cannot change under any rule.

use granular_edmd::Disk;
use granular_edmd::collision::{CollisionRule, Contact, Impulse, collide, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::strategies::{decades, direction, touching_pair};
use proptest::prelude::*;

use crate::kinematics::{EPSILON, angular_magnitude, angular_momentum, momentum, normal};
use crate::rules::{config, law};

/// Checks that momentum is conserved. Each component of each momentum is rounded a few times at its own size,
/// before and after.
fn momentum_is_conserved(before: (&Disk, &Disk), after: (&Disk, &Disk)) -> Result<(), TestCaseError> {
    let disks = [before.0, before.1, after.0, after.1];
    let magnitude: f64 = disks.iter().map(|disk| momentum(disk).length()).sum();
    let change = momentum(after.0) + momentum(after.1) - momentum(before.0) - momentum(before.1);
    prop_assert!(change.length() <= 8.0 * EPSILON * magnitude, "{change} of {magnitude}");
    Ok(())
}

/// Checks the same for the angular momentum about `point`, with the arms of the centers as further factors.
fn angular_momentum_is_conserved(
    point: DVec2,
    before: &[&Disk],
    after: &[&Disk],
) -> Result<(), TestCaseError> {
    let total = |disks: &[&Disk]| disks.iter().map(|disk| angular_momentum(disk, point)).sum::<f64>();
    let size = |disks: &[&Disk]| disks.iter().map(|disk| angular_magnitude(disk, point)).sum::<f64>();
    let (change, magnitude) = (total(after) - total(before), size(before) + size(after));
    prop_assert!(change.abs() <= 16.0 * EPSILON * magnitude, "{change} of {magnitude} about {point}");
    Ok(())
}

fn all_is_conserved<R: CollisionRule>(
    rule: &R,
    (first, second): (Disk, Disk),
    point: DVec2,
) -> Result<(), TestCaseError> {
    let after = collide(rule, &first, &second);
    let (new_first, new_second) = (after.first, after.second);
    momentum_is_conserved((&first, &second), (&new_first, &new_second))?;
    let touch = second.position() + normal(&first, &second) * second.radius();
    angular_momentum_is_conserved(touch, &[&first], &[&new_first])?;
    angular_momentum_is_conserved(touch, &[&second], &[&new_second])?;
    angular_momentum_is_conserved(point, &[&first, &second], &[&new_first, &new_second])
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn every_rule_conserves(law in law(), pair in touching_pair(), far in decades(-6.0, 6.0), way in direction()) {
        all_is_conserved(&law.rule(), pair, way * far)?;
    }

    /// Even a rule that breaks every other law conserves momentum.
    #[test]
    fn an_absurd_rule_conserves(pair in touching_pair(), push in -9.0..9.0, twist in -9.0..9.0, way in direction()) {
        let rule = from_fn(|contact: &Contact| {
            let scale = contact.tangential_mass() * contact.closing_speed();
            Impulse::new(push * scale, twist * scale)
        });
        all_is_conserved(&rule, pair, way)?;
    }

    /// Position, angle, radius, mass and inertia are not a collision's business.
    #[test]
    fn a_collision_moves_nothing(law in law(), (first, second) in touching_pair()) {
        let after = collide(&law.rule(), &first, &second);
        for (old, new) in [(first, after.first), (second, after.second)] {
            let restored = new.with_velocity(old.velocity()).unwrap();
            prop_assert_eq!(restored.with_angular_velocity(old.angular_velocity()).unwrap(), old);
        }
    }
}
