//! An observable.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Observable, Snapshot};

/// Angular momentum of all disks about a point, their rotation included.
#[derive(Debug, Clone, Copy)]
pub struct AngularMomentum {
    pub about: DVec2,
}

impl Observable for AngularMomentum {
    type Value = f64;

    fn measure(&self, snapshot: &Snapshot<'_>) -> f64 {
        let of = |disk: &Disk| {
            let orbital = (disk.position() - self.about).perp_dot(disk.mass() * disk.velocity());
            orbital + disk.moment_of_inertia() * disk.angular_velocity()
        };
        snapshot.disks().iter().map(of).sum()
    }
}
