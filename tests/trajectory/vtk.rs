//! Series for ParaView, without a reader of VTK: `.ci/readers` has one.

use std::fs;

use granular_edmd::glam::DVec2;
use granular_edmd::observable::SampleTimes;
use granular_edmd::trajectory::{RecordError, Recorder};

use crate::report::report;
use crate::scratch::Scratch;
use crate::states::mixture;

fn times() -> SampleTimes {
    SampleTimes::every(0.5).unwrap()
}

/// Names and contents of all files of a series.
fn files(scratch: &Scratch) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = fs::read_dir(scratch.path("run"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .chain([scratch.path("run.pvd")])
        .map(|path| (path.display().to_string(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

#[test]
fn a_killed_series_goes_on() {
    let scratch = Scratch::new("series");
    let path = scratch.path("run.pvd");
    let mut recorder = Recorder::create_vtk(&path, times()).unwrap();
    mixture().run_until(3.0, &mut recorder).unwrap();
    drop(recorder);
    let whole = files(&scratch);
    assert_eq!(whole.len(), 13);
    let text = fs::read(&path).unwrap();
    let line = String::from_utf8(text.clone()).unwrap();
    let (head, _) = line.split_once("<DataSet timestep=\"1.5\"").unwrap();
    for cut in (head.len()..=text.len()).step_by(23) {
        fs::write(&path, &text[..cut]).unwrap();
        // The files of the last frame may be torn, or missing.
        let last = scratch.path("run/disks_000005.vtp");
        let bytes = fs::read(&last).unwrap();
        fs::write(&last, &bytes[..cut % bytes.len()]).unwrap();
        let _ = fs::remove_file(scratch.path("run/box_000005.vtp"));
        let mut recorder = Recorder::append_vtk(&path, times()).unwrap();
        assert!(recorder.times().len() >= 2, "{cut}");
        if recorder.times().len() == 6 {
            // A kill cannot have done this, since files come before their line.
            fs::write(&last, bytes).unwrap();
            break;
        }
        mixture().run_until(3.0, &mut recorder).unwrap();
        drop(recorder);
        assert!(files(&scratch) == whole, "{cut}");
    }
}

#[test]
fn no_file_of_a_series_is_overwritten() {
    let scratch = Scratch::new("series-names");
    let path = scratch.path("run.pvd");
    fs::create_dir(scratch.path("run")).unwrap();
    fs::write(scratch.path("run/disks_000000.vtp"), "mine").unwrap();
    assert!(matches!(Recorder::create_vtk(&path, times()), Err(RecordError::Exists { .. })));
    fs::write(&path, "my notes").unwrap();
    assert!(matches!(Recorder::create_vtk(&path, times()), Err(RecordError::Exists { .. })));
    assert!(matches!(Recorder::append_vtk(&path, times()), Err(RecordError::NoFrame { .. })));
    assert_eq!(fs::read_to_string(&path).unwrap(), "my notes");
    assert_eq!(fs::read_to_string(scratch.path("run/disks_000000.vtp")).unwrap(), "mine");
    let error = Recorder::create_vtk(scratch.path("run.vtk"), times()).unwrap_err();
    assert!(report(&error).ends_with("the name must be of Unicode letters and end in .pvd"));
}

#[test]
fn a_series_that_somebody_has_changed_is_left() {
    let scratch = Scratch::new("series-changed");
    let path = scratch.path("run.pvd");
    mixture().run_until(3.0, &mut Recorder::create_vtk(&path, times()).unwrap()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for changed in
        [text.replace("000004", "000005"), text.clone() + "<!-- my notes -->", text.replace("2.5", "2.50")]
    {
        fs::write(&path, &changed).unwrap();
        assert!(matches!(Recorder::append_vtk(&path, times()), Err(RecordError::Io { .. })), "{changed}");
        assert_eq!(fs::read_to_string(&path).unwrap(), changed);
    }
}

/// The parts of a vessel are lines beside the edges of the box.
#[test]
fn the_parts_of_a_vessel_are_lines() {
    let scratch = Scratch::new("series-walls");
    let path = scratch.path("run.pvd");
    let wall = |time: f64| vec![vec![DVec2::new(time, 0.0), DVec2::ONE], vec![DVec2::ZERO; 3]];
    let mut recorder = Recorder::create_vtk(&path, times()).unwrap().with_walls(wall);
    mixture().run_until(1.0, &mut recorder).unwrap();
    drop(recorder);
    let edges = |number: u32| fs::read_to_string(scratch.path(&format!("run/box_{number:06}.vtp"))).unwrap();
    for number in 0..2 {
        assert!(edges(number).contains("NumberOfPoints=\"9\" NumberOfLines=\"5\""), "{}", edges(number));
    }
    assert!(edges(0) != edges(1));
}
