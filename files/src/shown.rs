//! Properties of disks and boxes in the form in which several formats write them.

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

/// Returns the disks with their ids, or with the ids 1, 2, 3, … if some have no id, because they do not come
/// from a simulation.
pub(super) fn numbered(disks: &[Disk]) -> impl Iterator<Item = (u64, &Disk)> {
    let are_known = disks.iter().all(|disk| disk.id() != 0);
    disks.iter().zip(1_u64..).map(move |(disk, number)| (if are_known { disk.id() } else { number }, disk))
}

/// Returns the orientation as the first and the last component of a quaternion: cosine and sine of half the
/// angle.
pub(super) fn half_turn(disk: &Disk) -> [f64; 2] {
    let half = 0.5 * disk.angle();
    [libm::cos(half), libm::sin(half)]
}

/// Returns the top of the box, above the highest disk if the box is open, for programs that have no open
/// boxes.
pub(super) fn shown_top(domain: &Domain, disks: &[Disk]) -> f64 {
    if domain.top.is_finite() {
        return domain.top;
    }
    let highest = disks.iter().map(|disk| disk.position().y + 2.0 * disk.radius());
    highest.fold(domain.bottom + domain.width(), f64::max)
}

/// Returns the depth of the box: the diameter of the largest disk, or 1 without disks.
pub(super) fn shown_depth(disks: &[Disk]) -> f64 {
    let radius = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    if radius > 0.0 { 2.0 * radius } else { 1.0 }
}
