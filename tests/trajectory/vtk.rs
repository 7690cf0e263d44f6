//! Series for ParaView, without a reader of VTK: `.ci/readers` has one.

use std::fs;

use granular_edmd::boundary::{Container, Part, Vessel};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::SampleTimes;
use granular_edmd::trajectory::{RecordError, Recorder, Vtk};
use granular_edmd::{Disk, Simulation};

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
    let mut recorder = Recorder::create(&path, Vtk, times()).unwrap();
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
        let mut recorder = Recorder::append(&path, Vtk, times()).unwrap();
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
    assert!(matches!(Recorder::create(&path, Vtk, times()), Err(RecordError::Exists { .. })));
    fs::write(&path, "my notes").unwrap();
    assert!(matches!(Recorder::create(&path, Vtk, times()), Err(RecordError::Exists { .. })));
    assert!(matches!(Recorder::append(&path, Vtk, times()), Err(RecordError::NoFrame { .. })));
    assert_eq!(fs::read_to_string(&path).unwrap(), "my notes");
    assert_eq!(fs::read_to_string(scratch.path("run/disks_000000.vtp")).unwrap(), "mine");
    let error = Recorder::create(scratch.path("run.vtk"), Vtk, times()).unwrap_err();
    assert!(report(&error).ends_with("the name must be of Unicode letters and end in .pvd"));
}

#[test]
fn a_series_that_somebody_has_changed_is_left() {
    let scratch = Scratch::new("series-changed");
    let path = scratch.path("run.pvd");
    mixture().run_until(3.0, &mut Recorder::create(&path, Vtk, times()).unwrap()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    for changed in
        [text.replace("000004", "000005"), text.clone() + "<!-- my notes -->", text.replace("2.5", "2.50")]
    {
        fs::write(&path, &changed).unwrap();
        assert!(matches!(Recorder::append(&path, Vtk, times()), Err(RecordError::Io { .. })), "{changed}");
        assert_eq!(fs::read_to_string(&path).unwrap(), changed);
    }
}

/// The parts of a vessel are lines beside the edges of the box, as long as the run has them.
#[test]
fn the_walls_are_those_of_the_run() {
    let scratch = Scratch::new("series-walls");
    let path = scratch.path("run.pvd");
    let place = |x, y| DVec2::new(x, y);
    let paddle = Part::polyline([place(2.0, 5.0), place(8.0, 5.0)]).unwrap();
    let paddle = paddle.with_rotation(place(5.0, 5.0), 0.3).unwrap();
    let gate = Part::polyline([place(1.0, 9.0), place(4.0, 9.0), place(9.0, 9.0)]).unwrap();
    let container = Container::closed(10.0, 20.0).unwrap();
    let mut vessel = Vessel::new(container).with("paddle", paddle).unwrap().with("gate", gate).unwrap();
    let disk = Disk::new(place(5.0, 15.0), 0.5).unwrap();
    let mut run = Simulation::builder(Elastic, vessel.clone()).disks([disk]).build().unwrap();
    let mut recorder = Recorder::create(&path, Vtk, times()).unwrap();
    run.run_until(1.0, &mut recorder).unwrap();
    vessel.remove("gate").unwrap();
    run.set_boundary(vessel).unwrap();
    run.run_until(1.5, &mut recorder).unwrap();
    drop(recorder);
    let edges = |number: u32| fs::read_to_string(scratch.path(&format!("run/box_{number:06}.vtp"))).unwrap();
    for (number, head) in [(0, (10, 7)), (1, (10, 7)), (2, (6, 5))] {
        let head = format!("NumberOfPoints=\"{}\" NumberOfLines=\"{}\"", head.0, head.1);
        assert!(edges(number).contains(&head), "{}", edges(number));
    }
    assert!(edges(0) != edges(1), "the paddle turns");
}
