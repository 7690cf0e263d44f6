//! A small run, and the files that it writes.

use std::fs;
use std::path::{Path, PathBuf};

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::simulation::Checkpoint;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Simulation, initial};

/// Magic, version and checksum come before the contents of every sealed file.
pub(crate) const VERSION_AT: usize = 8;
pub(crate) const CHECKSUM_AT: usize = 12;
pub(crate) const CONTENTS_AT: usize = 44;

pub(crate) fn rule() -> ContactDuration<Frictional> {
    ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2).unwrap(), 1e-3).unwrap()
}

pub(crate) fn container() -> Container {
    let base = BiParabolic::new(0.1, 3.0).unwrap();
    Container::closed(5.0, 4.0).unwrap().with_motion(Wall::Floor, base).unwrap()
}

/// A run of four disks, some way in.
pub(crate) fn checkpoint() -> Checkpoint {
    let disks = initial::lattice(&container(), 4, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let builder = Simulation::builder(rule(), container()).disks(disks).gravity(0.1);
    let mut run = builder.build().unwrap();
    run.run_until(3.0, &mut ()).unwrap();
    run.checkpoint()
}

/// Contents behind the seal of `like`.
pub(crate) fn sealed(like: &[u8], contents: &[u8]) -> Vec<u8> {
    [&like[..CHECKSUM_AT], blake3::hash(contents).as_bytes(), contents].concat()
}

/// A folder for one test, removed with it.
pub(crate) struct Scratch(pub(crate) PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let name = format!("hostile-{name}-{}", std::process::id());
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
