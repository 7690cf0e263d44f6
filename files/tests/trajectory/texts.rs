//! Files of disks with random changes, cut anywhere, or of random bytes: the reader gives an error that
//! names a line, or disks that survive their file.

use std::fs;
use std::path::Path;

use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Gravity, initial};
use granular_edmd_files::{ExtendedXyz, Frame, FrameFormat, LammpsDump, ReadError, Reader, State};
use proptest::prelude::*;

use crate::edits::{edit, edited};
use support::cases::config;

fn disks() -> Vec<Disk> {
    let container = Container::closed(8.0, 8.0).unwrap();
    initial::with_maxwellian_velocities(initial::lattice(&container, 6, 0.5).unwrap(), 1.0, 3).unwrap()
}

/// The texts of all formats that the library writes and reads.
fn texts() -> [(&'static str, String); 4] {
    let disks = disks();
    let snapshot = Snapshot::new(0.25, &disks, Container::closed(8.0, 8.0).unwrap().domain(), 0.1);
    let state = State::of(&snapshot);
    let text = |write: &dyn Fn(&mut Vec<u8>) -> std::io::Result<()>| {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let frame = Frame::new(0, &snapshot);
    [
        ("extended XYZ", text(&|out| ExtendedXyz.write_frame(&frame, out))),
        ("dump", text(&|out| LammpsDump.write_frame(&frame, out))),
        ("CSV", text(&|out| state.write_csv(out))),
        ("LAMMPS data", text(&|out| state.write_lammps_data(out))),
    ]
}

fn read(bytes: &[u8]) -> Result<State, ReadError> {
    Reader::new().read_from(bytes)
}

/// Checks what came of a file that may hold anything.
fn is_sound(read: &Result<State, ReadError>) -> bool {
    match read {
        Ok(state) => {
            let is_sound = |disk: &Disk| disk.position().is_finite() && disk.radius() > 0.0;
            let is_finite = |gravity: Gravity| gravity.acceleration().is_finite();
            state.disks().iter().all(is_sound)
                && state.time().is_none_or(f64::is_finite)
                && state.gravity().is_none_or(is_finite)
                && state.domain().is_none_or(|domain| domain.width() > 0.0 && domain.top > domain.bottom)
        }
        // A message is for people: whatever is in the file, it fits on a screen.
        Err(error) => error.to_string().len() < 2000,
    }
}

#[test]
fn the_texts_themselves_are_read() {
    for (name, text) in texts() {
        let state = read(text.as_bytes()).unwrap();
        assert_eq!((state.disks().len(), state.notes()), (6, Vec::new()), "{name}");
    }
}

/// A cut file is refused, or the reader tells that its last number may be cut. A table says nowhere how many
/// rows it has, and a data file need not have velocities.
#[test]
fn texts_cut_at_every_byte() {
    for (name, text) in texts() {
        for cut in 0..text.len() {
            let bytes = &text.as_bytes()[..cut];
            let is_whole = name == "CSV" || name == "LAMMPS data" && !text[..cut].contains("Velocities");
            let is_whole = is_whole && bytes.ends_with(b"\n");
            match read(bytes) {
                Ok(state) => assert!(is_whole || !state.notes().is_empty(), "{name}, cut at {cut}"),
                Err(error) => assert!(error.to_string().len() < 2000, "{name}, cut at {cut}: {error}"),
            }
        }
    }
}

/// Numbers of disks, steps and columns for which there is no room anywhere.
#[test]
fn huge_numbers_are_only_numbers() {
    let most = u64::MAX;
    for text in [
        format!("{most}\nProperties=pos:R:2:radius:R:1\n1 2 0.5\n"),
        format!("1\nProperties=pos:R:2:radius:R:1:a:R:{most}\n1 2 0.5\n"),
        format!("1\nProperties=pos:R:2:radius:R:1:id:I:1\n1 2 0.5 {most}\n"),
        format!("ITEM: TIMESTEP\n{most}\nITEM: NUMBER OF ATOMS\n{most}\nITEM: ATOMS x y radius\n1 2 0.5\n"),
        format!("\n{most} atoms\n0 9 xlo xhi\n0 9 ylo yhi\n\nAtoms\n\n1 1 1 1 2 2 0\n"),
        format!("id,x,y,radius,image_x\n{most},1,2,0.5,{most}\n"),
        "9".repeat(100_000),
        "1\n".to_owned() + &"[".repeat(100_000),
        "x,y,radius\n".to_owned() + &",".repeat(100_000),
        "\"".repeat(100_000) + "\n",
        "x,y,radius,".to_owned() + &"a".repeat(100_000) + "\n1,2\n",
        "ITEM: BOX BOUNDS ".to_owned() + &"p".repeat(100_000) + "\n",
        "1\n".to_owned() + &"a".repeat(100_000) + "=\"\n",
    ] {
        assert!(read(text.as_bytes()).is_err_and(|error| error.to_string().len() < 2000), "{text:.80}");
    }
    // Disks on one heap: so many overlap that counting them all would take for ever.
    let heap = "x,y,radius\n".to_owned() + &"1,2,0.5\n".repeat(200_000);
    let begun = std::time::Instant::now();
    assert!(read(heap.as_bytes()).is_err());
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

/// Files of other programs, of each format.
fn files() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/trajectory/files");
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending != "py"));
    paths.sort();
    paths.into_iter().map(|path| (path.display().to_string(), fs::read(path).unwrap())).collect()
}

/// A change of a file: bytes at a place, given as a share of its length, that take the place of others.
fn change() -> impl Strategy<Value = (f64, usize, Vec<u8>)> {
    let number =
        prop::sample::select(vec![0, 1, 2, 255, 1 << 16, 1 << 31, u64::from(u32::MAX), 1 << 62, u64::MAX]);
    let reals = prop::sample::select(vec![f32::NAN, f32::INFINITY, -0.0, 1e-40, f32::MAX]);
    let bytes = prop_oneof![
        any::<u8>().prop_map(|byte| vec![byte]),
        number.prop_map(|number| number.to_le_bytes().to_vec()),
        reals.prop_map(|real| real.to_le_bytes().to_vec()),
        prop::collection::vec(any::<u8>(), 0..12),
    ];
    // The head and the index of a file say what the rest means.
    let place = prop_oneof![0.0..1.0, (0.0..1.0_f64).prop_map(|place| place.powi(4))];
    (place, 0..12_usize, bytes)
}

fn changed(bytes: &[u8], changes: &[(f64, usize, Vec<u8>)]) -> Vec<u8> {
    changes.iter().fold(bytes.to_vec(), |mut bytes, (place, removed, inserted)| {
        let start = (place * bytes.len() as f64) as usize;
        let end = (start + removed).min(bytes.len());
        bytes.splice(start..end, inserted.iter().copied());
        bytes
    })
}

proptest! {
    #![proptest_config(config(300))]

    /// As many bytes are inserted as removed in half of the cases, so that the places in an index remain.
    #[test]
    fn changed_files_are_read_or_refused(
        mut changes in prop::collection::vec(change(), 1..4),
        keeps in any::<bool>(),
        frame in -3..3_isize,
    ) {
        if keeps {
            for (_, removed, inserted) in &mut changes {
                *removed = inserted.len();
            }
        }
        for (name, bytes) in files() {
            let bytes = changed(&bytes, &changes);
            let read = Reader::new().with_frame(frame).read_from(bytes.as_slice());
            prop_assert!(is_sound(&read), "{}: {:?}", name, read);
        }
    }
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn random_texts_are_read_or_refused(edits in prop::collection::vec(edit(), 1..5)) {
        for (name, text) in texts() {
            let text = edited(&text, &edits);
            let read = read(text.as_bytes());
            prop_assert!(is_sound(&read), "{}: {:?}, {}", name, read, text);
        }
    }

    #[test]
    fn random_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400), kept in 0..400_usize) {
        prop_assert!(is_sound(&read(&bytes)));
        for (name, text) in texts() {
            let bytes = [&text.as_bytes()[..kept.min(text.len())], bytes.as_slice()].concat();
            prop_assert!(is_sound(&read(&bytes)), "{}", name);
        }
    }
}
