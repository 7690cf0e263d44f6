//! Faults of the machine, for real: full disks, folders that cannot be written, processes killed at any
//! moment.
//!
//! A test that the system does not permit (mounting, another user) is reported and skipped.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use granular_edmd::Simulation;
use granular_edmd::simulation::Checkpoint;
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Control, Experiment, Plan, Protocol, Study};

use crate::limits::{Limits, in_child};
use crate::logs::{self, contents};
use crate::mixture::{Mixture, mixture};
use crate::specimens::{Scratch, checkpoint, container, rule};
use support::report::report;

const FOLDER: &str = "GRANULAR_EDMD_HOSTILE_FOLDER";

/// The tests that run in a separate process: a study of the box, and one of a user's experiment.
const CHILD: &str = "faults::child_runs_a_study";
const OWN_CHILD: &str = "faults::child_runs_a_study_of_its_own";

/// Three ramps of one value, with records of some kilobytes.
fn plan() -> Plan<VibratedBox> {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(60, 12.0, base).with_height(20.0).with_contact_duration(1e-3);
    let axis = Axis::new("friction", [0.1, 0.2, 0.3]).unwrap();
    Plan::new(experiment, Protocol::new(10, 20, 2).unwrap(), 5).unwrap().with_axis(axis).unwrap()
}

/// The same for a user's experiment.
fn own_plan() -> Plan<Mixture> {
    let axis = Axis::new("loss", [0.0, 0.1, 0.2]).unwrap();
    Plan::new(mixture(), Protocol::new(10, 80, 2).unwrap(), 5).unwrap().with_axis(axis).unwrap()
}

fn expected<E: Experiment>(name: &str, plan: &Plan<E>) -> BTreeMap<PathBuf, Vec<u8>> {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, plan).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    contents(&scratch.0)
}

/// Runs the study in a folder, saving at every step.
fn run<E: Experiment>(folder: &Path, plan: &Plan<E>) -> Result<bool, String> {
    let study = Study::open_or_create(folder, plan).map_err(|error| report(&error))?;
    let control = Control::default().with_save_interval(Duration::ZERO);
    study.run(&control).map(|summary| summary.is_complete()).map_err(|error| report(&error))
}

#[test]
#[ignore = "started by the tests of faults"]
fn child_runs_a_study() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    println!("the study ends with {:?}", run(Path::new(&folder), &plan()));
}

#[test]
#[ignore = "started by the tests of faults"]
fn child_runs_a_study_of_its_own() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    println!("the study ends with {:?}", run(Path::new(&folder), &own_plan()));
}

#[test]
#[ignore = "started by the tests of faults"]
fn child_writes_checkpoints() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let states = two_states();
    for state in states.iter().cycle() {
        state.write(Path::new(&folder).join("state")).unwrap();
    }
}

fn two_states() -> [Checkpoint; 2] {
    let first = checkpoint();
    let mut run = Simulation::resume(&first, rule(), container()).build().unwrap();
    run.run_until(9.0, &mut ()).unwrap();
    [first, run.checkpoint()]
}

/// A small file system of one test, or `None` where it cannot be made.
struct Disk(Scratch);

impl Disk {
    fn new(name: &str, size: &str) -> Option<Self> {
        let scratch = Scratch::new(name);
        let options = format!("size={size}");
        let mounted = mount(&["-t", "tmpfs", "-o", &options, "tmpfs"], &scratch.0);
        if !mounted {
            eprintln!("SKIPPED {name}: this process must not mount a file system; root may");
        }
        mounted.then(|| Self(scratch))
    }

    fn folder(&self) -> &Path {
        &self.0.0
    }

    fn remount(&self, options: &str) {
        // A test beside this one may be starting a program: until that has begun, it holds a copy of every
        // file that was open here, and a disk with files open for writing cannot become read-only.
        let remounted = (0..500).any(|_| {
            let done = mount(&["-o", &format!("remount,{options}")], self.folder());
            if !done {
                thread::sleep(Duration::from_millis(20));
            }
            done
        });
        assert!(remounted, "{options}");
    }
}

fn mount(arguments: &[&str], folder: &Path) -> bool {
    let status = Command::new("mount").args(arguments).arg(folder).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.folder()).status();
    }
}

fn survives_a_full_disk<E: Experiment>(name: &str, plan: &Plan<E>) {
    let Some(disk) = Disk::new(name, "24k") else { return };
    let folder = disk.folder().join("study");
    let error = run(&folder, plan).unwrap_err();
    assert!(error.starts_with("cannot write") && error.contains("No space left"), "{error}");
    disk.remount("size=16m");
    assert_eq!(run(&folder, plan), Ok(true));
    assert!(contents(&folder) == expected(&format!("{name}-not"), plan));
}

#[test]
fn a_study_survives_a_full_disk() {
    survives_a_full_disk("full", &plan());
    survives_a_full_disk("full-own", &own_plan());
}

fn survives_a_limit<E: Experiment>(name: &str, plan: &Plan<E>, child: &str) {
    let scratch = Scratch::new(name);
    let folder = scratch.0.join("study");
    let limits = Limits { memory_kib: 4 << 20, seconds: 100, file_kib: Some(2) };
    let end = in_child(child, &limits, &[(FOLDER, folder.to_str().unwrap())]);
    let said = end.said();
    assert!(said.contains("Err(\"cannot write") && said.contains("File too large"), "{said}");
    assert!(contents(&folder).keys().all(|name| name.extension().is_none_or(|ending| ending != "tmp")));
    assert_eq!(run(&folder, plan), Ok(true));
    assert!(contents(&folder) == expected(&format!("{name}-not"), plan));
}

#[test]
fn a_study_survives_a_limit_of_the_file_size() {
    survives_a_limit("limit", &plan(), CHILD);
    survives_a_limit("limit-own", &own_plan(), OWN_CHILD);
}

#[test]
fn a_checkpoint_survives_a_full_disk() {
    let Some(disk) = Disk::new("full-checkpoint", "16k") else { return };
    let path = disk.folder().join("state");
    let [old, new] = two_states();
    old.write(&path).unwrap();
    let _ = fs::write(disk.folder().join("filler"), vec![0; 1 << 16]);
    let error = report(&new.write(&path).unwrap_err());
    assert!(error.contains("No space left"), "{error}");
    assert_eq!(Checkpoint::read(&path).unwrap(), old);
    assert_eq!(fs::read_dir(disk.folder()).unwrap().count(), 2, "nothing is left of the attempt");
    fs::remove_file(disk.folder().join("filler")).unwrap();
    new.write(&path).unwrap();
    assert_eq!(Checkpoint::read(&path).unwrap(), new);
}

#[test]
fn a_disk_that_turns_read_only_keeps_what_it_has() {
    let Some(disk) = Disk::new("read-only-disk", "16m") else { return };
    let folder = disk.folder().join("study");
    assert_eq!(run(&folder, &plan()), Ok(true));
    logs::forget(&folder, 1, 0);
    let path = disk.folder().join("state");
    let [old, new] = two_states();
    old.write(&path).unwrap();
    disk.remount("ro");
    let error = run(&folder, &plan()).unwrap_err();
    assert!(error.starts_with("cannot write") && error.contains("Read-only"), "{error}");
    assert_eq!(Study::<VibratedBox>::open(&folder).unwrap().records().map(Result::unwrap).count(), 2);
    assert!(report(&new.write(&path).unwrap_err()).contains("Read-only"));
    assert_eq!(Checkpoint::read(&path).unwrap(), old);
    disk.remount("rw");
    assert_eq!(run(&folder, &plan()), Ok(true));
    assert!(contents(&folder) == expected("read-only-disk-not", &plan()));
}

/// Permissions do not bind the superuser, so the study is run as the user "nobody".
#[test]
fn a_folder_of_somebody_else_is_an_error() {
    let scratch = Scratch::new("somebody-else");
    let folder = scratch.0.join("study");
    assert_eq!(run(&folder, &plan()), Ok(true));
    // There is something to do again.
    logs::forget(&folder, 1, 0);
    let before = contents(&folder);
    let executable = std::env::current_exe().unwrap();
    let output = Command::new("setpriv")
        .args(["--reuid=65534", "--regid=65534", "--clear-groups"])
        .arg(&executable)
        .args(["--exact", CHILD, "--ignored", "--nocapture"])
        .env(FOLDER, &folder)
        .output();
    match output {
        Ok(output) if output.status.success() => {
            let said = String::from_utf8_lossy(&output.stdout).into_owned();
            assert!(said.contains("Err(\"cannot write") && said.contains("ermission denied"), "{said}");
        }
        other => eprintln!("SKIPPED: this process must not become nobody: {other:?}"),
    }
    assert!(contents(&folder) == before, "nothing has changed");
}

/// Delays that look random and are the same on every run.
fn delays(seed: u64, longest: u64) -> impl Iterator<Item = Duration> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Duration::from_micros((state >> 33) % (1000 * longest))
    })
}

fn start(test: &str, folder: &Path) -> std::process::Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", test, "--ignored"]).env(FOLDER, folder);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Kills the study at random moments, then lets it end.
fn killed<E: Experiment>(
    plan: &Plan<E>,
    child: &str,
    round: u64,
    kills: usize,
) -> BTreeMap<PathBuf, Vec<u8>> {
    let scratch = Scratch::new(&format!("killed-{round}"));
    let folder = scratch.0.join("study");
    for delay in delays(round, 60).take(kills) {
        let mut child = start(child, &folder);
        std::thread::sleep(delay);
        let _ = child.kill();
        child.wait().unwrap();
    }
    assert_eq!(run(&folder, plan), Ok(true));
    contents(&folder)
}

/// Checks file by file, so that a failure names the file.
fn assert_same(found: &BTreeMap<PathBuf, Vec<u8>>, expected: &BTreeMap<PathBuf, Vec<u8>>) {
    assert!(found.keys().eq(expected.keys()), "{:?} {:?}", found.keys(), expected.keys());
    for (name, bytes) in expected {
        assert!(found[name] == *bytes, "{} differs", name.display());
    }
}

#[test]
fn studies_killed_at_random_moments_end_with_the_same_bytes() {
    let (of_the_box, own) = (expected("killed-not", &plan()), expected("killed-own-not", &own_plan()));
    for round in 0..2 {
        assert_same(&killed(&plan(), CHILD, round, 8), &of_the_box);
        assert_same(&killed(&own_plan(), OWN_CHILD, 2 + round, 8), &own);
    }
}

#[test]
#[ignore = "a minute: the same at many more moments"]
fn studies_killed_at_many_random_moments_end_with_the_same_bytes() {
    let expected = expected("killed-often-not", &plan());
    for round in 100..130 {
        assert_same(&killed(&plan(), CHILD, round, 25), &expected);
    }
}

#[test]
fn a_checkpoint_is_whole_whenever_its_writer_is_killed() {
    let scratch = Scratch::new("killed-writer");
    let (path, states) = (scratch.0.join("state"), two_states());
    states[0].write(&path).unwrap();
    for delay in delays(7, 40).take(15) {
        let mut child = start("faults::child_writes_checkpoints", &scratch.0);
        std::thread::sleep(delay);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(states.contains(&Checkpoint::read(&path).unwrap()));
    }
}
