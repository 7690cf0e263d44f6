//! The length of an epoch, by the pace of the disks.

use glam::DVec2;

use super::bodies::Bodies;

/// Diameters that a typical disk goes, or falls, in an epoch.
const DIAMETERS: f64 = 64.0;

/// The factor by which a disk may be faster than a typical one before it decides how often the epoch moves.
const FASTER: f64 = 16.0;

impl Bodies {
    /// The length of an epoch: a typical disk goes, or falls, some tens of diameters in it, and none [`FASTER`] times as far.
    pub(in crate::simulation) fn epoch_length(&self) -> f64 {
        let squares = || self.particles.iter().map(|particle| particle.trajectory.velocity.length_squared());
        let typical = (squares().sum::<f64>() / self.len() as f64).sqrt();
        self.epoch_length_at(typical.max(squares().fold(0.0, f64::max).sqrt() / FASTER))
    }

    /// Returns the length of an epoch under another gravity.
    pub(in crate::simulation) fn epoch_length_under(&mut self, gravity: f64) -> f64 {
        let own = std::mem::replace(&mut self.gravity, gravity);
        let length = self.epoch_length();
        self.gravity = own;
        length
    }

    /// Tells whether a disk of this velocity goes no further in an epoch of this length than any should. A collision can make a
    /// disk faster than all were; its place at the epoch, so far away, would lack digits.
    #[inline]
    pub(in crate::simulation) fn keeps_pace(&self, velocity: DVec2, epoch_length: f64) -> bool {
        let most = FASTER * DIAMETERS * self.typical_diameter;
        (velocity * epoch_length).length_squared() <= most * most
    }

    /// The length of an epoch that suits a disk of this velocity, too.
    pub(in crate::simulation) fn epoch_length_for(&self, velocity: DVec2) -> f64 {
        self.epoch_length_at(velocity.length() / FASTER)
    }

    /// A power of two, so that epochs add up without rounding.
    fn epoch_length_at(&self, speed: f64) -> f64 {
        let way = DIAMETERS * self.typical_diameter;
        let length = way / (speed + (self.gravity.abs() * way).sqrt());
        // Without disks it is no number. Where all are at rest it is endless: nothing that a horizon would have to be looked past.
        if length > 0.0 { power_of_two_below(length) } else { 1.0 }
    }
}

/// The largest power of two that is not above a positive number, and not so small or large that its square is none.
fn power_of_two_below(number: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    let number = number.clamp(f64::from_bits((1023 - 900) << 52), f64::from_bits((1023 + 900) << 52));
    // Without its fraction a float is its power of two: exact, where a logarithm would be rounded.
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
