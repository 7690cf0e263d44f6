//! Files of GSD, without a reader of GSD: `.ci/readers` has two.

use std::fs;
use std::path::Path;

use granular_edmd::boundary::Domain;
use granular_edmd::observable::{SampleTimes, Snapshot};
use granular_edmd_files::{Gsd, RecordError, Recorder};

use crate::scratch::Scratch;
use crate::states::{domain, mixture, random_disks};
use support::report::report;

/// Bytes of the entries of a frame with a moving wall.
const FRAME: usize = 24 * 32;

fn times() -> SampleTimes {
    SampleTimes::every(0.5).unwrap()
}

/// Returns the bytes of a file of six frames.
fn recorded(path: &Path) -> Vec<u8> {
    mixture().run_until(3.0, &mut Recorder::create(path, Gsd, times()).unwrap()).unwrap();
    fs::read(path).unwrap()
}

/// A process may die with the index as long as it was, or with all entries of the last frame but the first,
/// and with any part of the chunks. The file then ends like that of a run that was left alone.
#[test]
fn a_killed_run_goes_on_in_the_same_file() {
    let scratch = Scratch::new("gsd-kill");
    let path = scratch.path("run.gsd");
    let whole = recorded(&path);
    let place = |number: usize| 256 + number * FRAME;
    let start = |number: usize| {
        u64::from_le_bytes(whole[place(number) + 16..place(number) + 24].try_into().unwrap()) as usize
    };
    for frames in [2, 3, 5] {
        for (end, from) in
            [(start(frames), 0), (start(frames) + 1000, 0), (whole.len(), 0), (whole.len(), 32)]
        {
            let mut torn = whole[..end].to_vec();
            torn[place(frames) + from..place(6)].fill(0);
            torn[place(frames)..place(frames) + 32].fill(0);
            fs::write(&path, torn).unwrap();
            let (mut run, mut recorder) = (mixture(), Recorder::append(&path, Gsd, times()).unwrap());
            assert_eq!(recorder.times().len(), frames);
            run.run_until(1.0, &mut ()).unwrap();
            run.run_until(3.0, &mut recorder).unwrap();
            assert_eq!(recorder.times(), [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
            drop(recorder);
            assert!(fs::read(&path).unwrap() == whole, "{frames} frames, {end} bytes");
        }
    }
}

/// A file that was cut at any byte goes on from its last whole frame, or is refused if it has none. The file
/// then ends like that of a run that was left alone.
#[test]
fn a_cut_file_goes_on() {
    let scratch = Scratch::new("gsd-cut");
    let path = scratch.path("run.gsd");
    let whole = recorded(&path);
    let end = |number: usize| {
        let place = 256 + number * FRAME + 16;
        u64::from_le_bytes(whole[place..place + 8].try_into().unwrap()) as usize
    };
    for cut in (0..whole.len()).step_by(97).chain([end(0), end(1), end(2), end(5), end(5) + 1]) {
        fs::write(&path, &whole[..cut]).unwrap();
        let frames = (1..6).filter(|&number| end(number) <= cut).count();
        match Recorder::append(&path, Gsd, times()) {
            Err(error) => assert!(frames == 0, "{cut}: {}", report(&error)),
            Ok(mut recorder) => {
                assert_eq!(recorder.times().len(), frames, "{cut}");
                assert_eq!(fs::read(&path).unwrap(), whole[..cut], "a look changes nothing");
                mixture().run_until(3.0, &mut recorder).unwrap();
                assert_eq!(recorder.times().len(), 6);
                drop(recorder);
                assert!(fs::read(&path).unwrap() == whole, "{cut}");
            }
        }
    }
}

/// A cut within an index that was written again leaves the frames of the one before.
#[test]
fn a_cut_file_with_more_than_one_index_goes_on() {
    let scratch = Scratch::new("gsd-cut-index");
    let path = scratch.path("run.gsd");
    let mut recorder = Recorder::create(&path, Gsd, times()).unwrap();
    let at = |number: usize| Snapshot::new(0.25 * number as f64, &[], domain(0), 1.0);
    (0..200).for_each(|number| recorder.record(&at(number)).unwrap());
    drop(recorder);
    let (whole, mut seen) = (fs::read(&path).unwrap(), std::collections::BTreeSet::new());
    for cut in (0..whole.len()).rev().step_by(1009) {
        fs::write(&path, &whole[..cut]).unwrap();
        let Ok(mut recorder) = Recorder::append(&path, Gsd, times()) else { continue };
        seen.insert(recorder.times().len());
        (0..200).for_each(|number| recorder.record(&at(number)).unwrap());
        drop(recorder);
        assert!(fs::read(&path).unwrap() == whole, "{cut}");
    }
    assert!(seen.len() > 20 && seen.last() == Some(&199), "{seen:?}");
}

/// Frames of many shapes, more than the first index has room for.
#[test]
fn the_index_grows() {
    let scratch = Scratch::new("gsd-index");
    let path = scratch.path("run.gsd");
    let mut recorder = Recorder::create(&path, Gsd, times()).unwrap();
    let disks = random_disks(3, &domain(1));
    let at =
        |number: usize| Snapshot::new(0.25 * number as f64, &disks[..number % 7 * 5], domain(number), 1.0);
    (0..300).for_each(|number| recorder.record(&at(number)).unwrap());
    drop(recorder);
    let before = fs::read(&path).unwrap();
    let mut recorder = Recorder::append(&path, Gsd, times()).unwrap();
    assert_eq!(recorder.times().len(), 300);
    (0..300).for_each(|number| recorder.record(&at(number)).unwrap());
    assert!(fs::read(&path).unwrap() == before, "what is there is not written again");
    let other = Snapshot::new(1.0, &disks[..3], domain(0), 1.0);
    assert!(matches!(recorder.record(&other), Err(RecordError::AnotherRun { is_there: true, .. })));
    recorder.record(&at(300)).unwrap();
    assert_eq!(recorder.times().len(), 301);
}

#[test]
fn what_is_no_file_of_ours_is_left() {
    let scratch = Scratch::new("gsd-foreign");
    let path = scratch.path("run.gsd");
    let whole = recorded(&path);
    assert!(matches!(Recorder::create(&path, Gsd, times()), Err(RecordError::Exists { .. })));
    let packed = scratch.path("run.gsd.gz");
    let error = Recorder::create(&packed, Gsd, times()).unwrap_err();
    assert!(report(&error).ends_with("its name must not end in .gz") && !packed.exists());
    let other = |place: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[place] = byte;
        bytes
    };
    // The last case is a frame with an entry that is damaged, among whole ones.
    let damaged = other(256 + 2 * FRAME + 8, 9);
    let cases =
        [b"my notes".to_vec(), Vec::new(), other(0, 1), other(20, 0xff), other(50, b'x'), other(116, 0)];
    for bytes in cases.into_iter().chain([whole[..300].to_vec(), damaged]) {
        fs::write(&path, &bytes).unwrap();
        let error = Recorder::append(&path, Gsd, times()).unwrap_err();
        assert!(report(&error).contains("run.gsd"), "{}", report(&error));
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

/// A box without disks, and one that is open.
#[test]
fn sizes_are_those_of_the_table() {
    let scratch = Scratch::new("gsd-sizes");
    let path = scratch.path("run.gsd");
    let mut recorder = Recorder::create(&path, Gsd, times()).unwrap();
    let size = || fs::metadata(&path).unwrap().len();
    let empty = size();
    let domain = Domain::new(0.0, 10.0, 0.0, f64::INFINITY);
    recorder.record(&Snapshot::new(1.0, &[], domain, 1.0)).unwrap();
    assert_eq!(size() - empty, 8 + 1 + 24 + 4 + 6 + 2 + 72);
    let disks = random_disks(1, &domain);
    let kinds = disks.iter().map(|disk| u64::from(disk.kind().number()) + 1).max().unwrap();
    recorder.record(&Snapshot::new(2.0, &disks, domain, 1.0)).unwrap();
    assert_eq!(size() - empty, 2 * 111 + 6 * (1 + kinds) + 100 * disks.len() as u64);
}
