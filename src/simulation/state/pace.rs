//! The length of an epoch, which depends on the pace of the disks.

use glam::DVec2;

use super::bodies::Bodies;
use crate::Gravity;

/// Number of diameters that a typical disk moves, or falls, in an epoch.
const DIAMETERS: f64 = 64.0;

/// Factor by which a disk may be faster than a typical one before it decides how often the epoch moves.
const FASTER: f64 = 16.0;

/// Largest number of typical diameters that any disk moves in an epoch.
pub(in crate::simulation) const FARTHEST: f64 = FASTER * DIAMETERS;

impl Bodies {
    /// Returns the length of an epoch. A typical disk moves, or falls, tens of diameters in it, and no disk
    /// moves more than [`FASTER`] times as far.
    pub(in crate::simulation) fn epoch_length(&self) -> f64 {
        let squares = || self.particles.iter().map(|particle| particle.trajectory.velocity.length_squared());
        let typical = (squares().sum::<f64>() / self.len() as f64).sqrt();
        self.epoch_length_at(typical.max(squares().fold(0.0, f64::max).sqrt() / FASTER))
    }

    /// Returns the length of an epoch under another gravity.
    pub(in crate::simulation) fn epoch_length_under(&mut self, gravity: Gravity) -> f64 {
        let own = std::mem::replace(&mut self.gravity, gravity);
        let length = self.epoch_length();
        self.gravity = own;
        length
    }

    /// Returns whether a disk of this velocity moves no farther in an epoch of this length than is allowed.
    ///
    /// A collision can make a disk faster than all disks were when the epoch began. Its position at the epoch
    /// would be so far away that it would lack digits.
    #[inline]
    pub(in crate::simulation) fn keeps_pace(&self, velocity: DVec2, epoch_length: f64) -> bool {
        let most = FARTHEST * self.typical_diameter;
        (velocity * epoch_length).length_squared() <= most * most
    }

    /// Returns the length of an epoch that also suits a disk of this velocity.
    pub(in crate::simulation) fn epoch_length_for(&self, velocity: DVec2) -> f64 {
        self.epoch_length_at(velocity.length() / FASTER)
    }

    /// Returns the length of an epoch for this speed. It is a power of two, so that epochs add up without
    /// rounding.
    fn epoch_length_at(&self, speed: f64) -> f64 {
        let way = DIAMETERS * self.typical_diameter;
        let length = way / (speed + (self.gravity.strength() * way).sqrt());
        // The length is NaN without disks. It is infinite if all disks are at rest without gravity; no search
        // for a wall then needs a horizon.
        if length > 0.0 { power_of_two_below(length) } else { 1.0 }
    }
}

/// Returns the largest power of two that does not exceed a positive number. It is kept between 2⁻⁹⁰⁰ and
/// 2¹⁰²⁰.
///
/// Searches look two epochs ahead, which must be a finite time. Up to the last finite time, there are then
/// sixteen epochs at most, however slow the disks are.
fn power_of_two_below(number: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    let number = number.clamp(f64::from_bits((1023 - 900) << 52), f64::from_bits((1023 + 1020) << 52));
    // A float without its fraction is its power of two. This is exact, whereas a logarithm would be rounded.
    f64::from_bits(number.to_bits() & EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::power_of_two_below;

    #[test]
    fn powers_of_two_are_exact() {
        let next_below_8 = 8.0_f64.next_down();
        let cases =
            [(1.0, 1.0), (next_below_8, 4.0), (8.0, 8.0), (0.3, 0.25), (1e-300, f64::from_bits(123 << 52))];
        for (number, power) in cases {
            assert_eq!(power_of_two_below(number), power, "{number}");
        }
    }
}
