//! Mechanics of two touching bodies, written with vectors and without the library's formulas.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;

/// Rounding of one operation; each bound below is a number of operations times the magnitudes that enter
/// them.
pub(crate) const EPSILON: f64 = f64::EPSILON;

/// Unit vector from the second disk to the first.
pub(crate) fn normal(first: &Disk, second: &Disk) -> DVec2 {
    let line = first.position() - second.position();
    line / line.x.hypot(line.y)
}

/// Velocity of the point of `disk` at `arm` from its center, $`\vec v + \vec\omega\times\vec r`$.
pub(crate) fn surface_velocity(disk: &Disk, arm: DVec2) -> DVec2 {
    disk.velocity() + disk.angular_velocity() * DVec2::new(-arm.y, arm.x)
}

/// Relative velocity of the points in contact, $`\vec v_{C2} - \vec v_{C1}`$, along the normal and the
/// tangent.
pub(crate) fn contact_velocity(normal: DVec2, first: &Disk, second: &Disk) -> (f64, f64) {
    let velocity = surface_velocity(second, normal * second.radius())
        - surface_velocity(first, -normal * first.radius());
    (velocity.dot(normal), velocity.dot(DVec2::new(-normal.y, normal.x)))
}

pub(crate) fn momentum(disk: &Disk) -> DVec2 {
    disk.mass() * disk.velocity()
}

/// Angular momentum about `point`.
pub(crate) fn angular_momentum(disk: &Disk, point: DVec2) -> f64 {
    (disk.position() - point).perp_dot(momentum(disk)) + disk.moment_of_inertia() * disk.angular_velocity()
}

/// Size of the terms of [`angular_momentum`]: the arm is a difference of positions, and rounded at their
/// size.
pub(crate) fn angular_magnitude(disk: &Disk, point: DVec2) -> f64 {
    (disk.position().length() + point.length()) * momentum(disk).length()
        + disk.moment_of_inertia() * disk.angular_velocity().abs()
}

pub(crate) fn kinetic_energy(disk: &Disk) -> f64 {
    let spin = disk.angular_velocity() * disk.radius();
    0.5 * disk.mass() * (disk.velocity().length_squared() + disk.inertia_factor() * spin * spin)
}

/// Size of the speeds from which a contact velocity is computed.
pub(crate) fn speed_magnitude(disk: &Disk) -> f64 {
    disk.velocity().length() + disk.radius() * disk.angular_velocity().abs()
}
