//! Series for ParaView, without a reader of VTK: `.ci/readers` has one.

use std::fs;

use granular_edmd::boundary::{Container, Domain, Part, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{SampleTimes, Snapshot};
use granular_edmd::wall::{BiParabolic, Sinusoidal, WallMotion as _};
use granular_edmd::{Disk, Simulation};
use granular_edmd_files::{ByEnding, RecordError, Recorder, State, Vtk};

use crate::scratch::Scratch;
use crate::states::mixture;
use support::report::report;

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
    assert!(report(&error).ends_with("the name must be valid Unicode and end in .pvd"));
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
    let mut vessel = container.with_part("paddle", paddle).unwrap().with_part("gate", gate).unwrap();
    let disk = Disk::new(place(5.0, 15.0), 0.5).unwrap();
    let mut run = Simulation::builder(Elastic, vessel.clone()).disks([disk]).build().unwrap();
    let mut recorder = Recorder::create(&path, Vtk, times()).unwrap();
    run.run_until(1.0, &mut recorder).unwrap();
    vessel.remove_part("gate").unwrap();
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

/// Displacement and phase of each wall that moves are in the frames, and the box of a picture moves along.
#[test]
fn frames_tell_where_the_walls_are() {
    let scratch = Scratch::new("moving-walls");
    let place = |x, y| DVec2::new(x, y);
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    let container = Container::closed(10.0, 20.0).unwrap().with_motion(Wall::Floor, base).unwrap();
    let paddle = Part::polyline([place(2.0, 5.0), place(5.0, 6.0), place(8.0, 5.0)]).unwrap();
    let paddle = paddle.with_rotation(place(5.0, 5.0), 3.0).unwrap();
    let plate = Part::polyline([place(1.0, 12.0), place(9.0, 12.0)]).unwrap();
    let plate = plate.with_motion(place(0.0, 1.0), Sinusoidal::new(0.2, 4.0).unwrap()).unwrap();
    let vessel = container;
    let vessel = vessel.with_part("paddle", paddle).unwrap().with_part("plate", plate).unwrap();
    let disk = Disk::new(place(5.0, 15.0), 0.5).unwrap();
    let mut run = Simulation::builder(Elastic, vessel).disks([disk]).build().unwrap();
    let names = ["run.xyz", "run.gsd", "run.pvd"].map(|name| scratch.path(name));
    let mut all: Vec<Recorder> =
        names.iter().map(|path| Recorder::create(path, ByEnding, times()).unwrap()).collect();
    run.run_until(2.5, &mut all).unwrap();
    let walls = run.snapshot().moving_walls();
    assert_eq!(walls.iter().map(|wall| wall.0).collect::<Vec<_>>(), [0, 4, 9], "each part once");
    assert_eq!(walls[0].1, place(0.0, base.state(walls[0].2).displacement));
    assert!((walls[0].2 - 2.5 % base.period().unwrap()).abs() < 1e-12);
    assert_eq!(walls[1].1, DVec2::ZERO, "it only turns");
    assert!((walls[1].2 - 2.5 % (std::f64::consts::TAU / 3.0)).abs() < 1e-12);
    assert!((walls[2].1 - place(0.0, 0.2 * 10.0_f64.sin())).length() < 1e-12);
    assert_eq!(run.snapshot().edges().bottom, walls[0].1.y);
    assert!(run.snapshot().domain().bottom < -0.099);

    let text = fs::read_to_string(&names[0]).unwrap();
    let key = text.rsplit_once("Walls=\"").unwrap().1.split_once('"').unwrap().0;
    let numbers: Vec<f64> = key.split(' ').map(|number| number.parse().unwrap()).collect();
    let expected: Vec<f64> =
        walls.iter().flat_map(|&(wall, by, phase)| [wall as f64, by.x, by.y, phase]).collect();
    assert_eq!(numbers, expected);
    // The chunks of the walls are the last ones of a file of GSD.
    let bytes = fs::read(&names[1]).unwrap();
    let last: Vec<u8> = walls.iter().flat_map(|wall| wall.2.to_le_bytes()).collect();
    assert!(bytes.ends_with(&last));
    let edges = |number: u32| fs::read_to_string(scratch.path(&format!("run/box_{number:06}.vtp"))).unwrap();
    assert!(edges(3) != edges(4));
}

/// Returns the bytes of a text in base64, as RFC 4648 has it.
fn decoded(text: &str) -> Vec<u8> {
    let letters: String = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect();
    assert_eq!(text.len() % 4, 0);
    let (digits, padding) = text.split_at(text.find('=').unwrap_or(text.len()));
    assert!(padding.len() < 3);
    let bits = digits.chars().flat_map(|letter| {
        let digit = letters.find(letter).unwrap();
        (0..6).rev().map(move |bit| digit >> bit & 1)
    });
    let bits: Vec<usize> = bits.collect();
    bits.chunks_exact(8).map(|byte| byte.iter().fold(0, |sum, bit| 2 * sum + *bit as u8)).collect()
}

/// The arrays of 0 to 6 disks have all lengths of the last group of letters.
#[test]
fn arrays_are_in_base64_behind_their_length() {
    for count in 0..7_u64 {
        let id = |number: u64| number.wrapping_mul(0x1f_ffff_fedc_ba98) % (1 << 53) + 1;
        let disk = |number| Disk::new(DVec2::ZERO, 1.0).unwrap().with_id(id(number)).unwrap();
        let disks: Vec<Disk> = (0..count).map(disk).collect();
        let mut file = Vec::new();
        let domain = Domain::new(0.0, 1.0, 0.0, 1.0);
        State::of(&Snapshot::new(0.0, &disks, domain, 0.0)).write_vtk(&mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        let (_, array) = text.split_once("Name=\"id\" NumberOfComponents=\"1\" format=\"binary\">").unwrap();
        let expected = [8 * count].into_iter().chain((0..count).map(id)).flat_map(u64::to_le_bytes);
        assert!(decoded(array.split_once('<').unwrap().0).into_iter().eq(expected), "{count}");
    }
}
