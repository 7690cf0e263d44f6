//! Files of disks with random changes: each reader gives an error that names a line, or disks that survive
//! their file.

use std::io::Cursor;

use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::observable::Snapshot;
use granular_edmd::trajectory::{ExtendedXyz, Format, Frame, ReadError, Reader, State};
use granular_edmd::{Disk, initial};
use proptest::prelude::*;

use crate::cases::config;
use crate::edits::{edit, edited};

type Read = fn(Cursor<Vec<u8>>) -> Result<State, ReadError>;

fn disks() -> Vec<Disk> {
    let container = Container::closed(8.0, 8.0).unwrap();
    initial::with_maxwellian_velocities(initial::lattice(&container, 6, 0.5).unwrap(), 1.0, 3).unwrap()
}

fn with_snapshot<T>(disks: &[Disk], use_it: impl FnOnce(&Snapshot<'_>) -> T) -> T {
    use_it(&Snapshot::new(0.25, disks, Container::closed(8.0, 8.0).unwrap().domain(), 0.1))
}

/// The texts of all formats that the library reads, with their readers.
fn texts() -> Vec<(&'static str, String, Read)> {
    let disks = disks();
    let state = with_snapshot(&disks, State::of);
    let (mut xyz, mut csv, mut lammps) = (Vec::new(), Vec::new(), Vec::new());
    with_snapshot(&disks, |snapshot| ExtendedXyz.write_frame(&Frame::new(0, snapshot), &mut xyz)).unwrap();
    state.write_csv(&mut csv).unwrap();
    state.write_lammps_data(&mut lammps).unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    vec![
        ("extended XYZ", text(xyz), |input| Reader::new().read_from(input)),
        ("CSV", text(csv), |input| Reader::new().read_from(input)),
        ("LAMMPS data", text(lammps), |input| Reader::new().read_from(input)),
    ]
}

#[test]
fn the_texts_themselves_are_read() {
    for (name, text, read) in texts() {
        let state = read(Cursor::new(text.into_bytes())).unwrap();
        assert_eq!(state.disks().len(), 6, "{name}");
    }
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn random_texts_are_read_or_refused(edits in prop::collection::vec(edit(), 1..5)) {
        for (name, text, read) in texts() {
            let text = edited(&text, &edits);
            match read(Cursor::new(text.clone().into_bytes())) {
                Ok(state) => {
                    let is_sound = |disk: &Disk| disk.position().is_finite() && disk.radius() > 0.0;
                    prop_assert!(state.disks().iter().all(is_sound), "{}: {}", name, text);
                    prop_assert!(state.time().is_none_or(f64::is_finite), "{}: {}", name, text);
                }
                // A message is for people: whatever is in the file, it fits on a screen.
                Err(error) => prop_assert!(error.to_string().len() < 2000, "{}: {}", name, error),
            }
        }
    }
}
