//! Studies: the plan as data, the same bytes however they come about, and damage that is noticed.

#![cfg(feature = "serde")]

#[path = "support/cases.rs"]
mod cases;
#[path = "support/report.rs"]
mod report;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use granular_edmd::study::{
    Axis, Base, Control, Course, Leg, Outcome, Parameter, Progress, Protocol, Ramp, Specification, Study,
    StudyError, System,
};
use proptest::prelude::*;
use report::report;

type AnyError = Box<dyn std::error::Error>;

const BASE: Base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };

fn small_system() -> System {
    System::new(30, 10.0, BASE)
        .with_height(30.0)
        .with_gravity(0.015_625)
        .with_inelasticity(0.05)
        .with_contact_duration(1e-4)
}

/// Two ramps of five values.
fn small_study() -> Specification {
    let ramp = Ramp::new(Parameter::Friction, vec![0.01, 0.1, 0.3], Course::UpAndDown);
    Specification::new(small_system(), Protocol::new(25, 6, 10), 7)
        .and_then(|study| study.with_ramp(ramp))
        .and_then(|study| study.with_axis(Axis::new(Parameter::Inelasticity, vec![0.0, 0.02])))
        .unwrap()
}

/// A folder of this test's own, removed with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// All files of a study but the log, which has the times.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("log.jsonl") {
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// The study of `specification`, done without a break.
fn done(specification: &Specification, name: &str) -> (Scratch, Study) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, specification).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    (scratch, study)
}

fn assert_same(found: &Path, expected: &Path) {
    let (found, expected) = (contents(found), contents(expected));
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    for (name, bytes) in &expected {
        assert!(&found[name] == bytes, "{} differs", name.display());
    }
}

#[test]
fn a_study_records_what_it_was_asked_for() {
    let (_scratch, study) = done(&small_study(), "records");
    let records: Vec<_> = study.records().map(Result::unwrap).collect();
    assert_eq!(records.len(), 10);
    for record in &records {
        assert_eq!(record.outcome(), &Outcome::Completed);
        assert_eq!(record.samples().len(), 6);
        assert_eq!(record.seed(), study.specification().ramp_seed(record.ramp()));
        let sampled: u64 = record.samples().iter().map(|sample| sample.collisions).sum();
        assert!(sampled > 0 && sampled < record.counters().collisions, "settling has collisions too");
        // All disks are in the profile: its area is theirs.
        let area: f64 = record.profile().map(|(_, fraction)| fraction * 10.0).sum();
        approx::assert_relative_eq!(area, 30.0 * std::f64::consts::FRAC_PI_4, max_relative = 1e-3);
        assert!(record.energy_change().mean() < 0.0 && record.energy_change().standard_error() > 0.0);
        assert!(
            !record.energy_change().is_converged() && !record.mean(|sample| sample.height).is_converged()
        );
    }
    let friction: Vec<_> = records[..5].iter().map(|r| r.system().get(Parameter::Friction)).collect();
    assert_eq!(friction, [0.01, 0.1, 0.3, 0.1, 0.01].map(Some));
    assert_eq!(records[3].leg(), Some(Leg::Down));
    // Time goes on through a ramp, and samples are at whole periods.
    let period = std::f64::consts::TAU / 10.0;
    approx::assert_relative_eq!(records[1].samples()[0].time, (85.0 + 35.0) * period, max_relative = 1e-12);
    assert_ne!(records[0].samples(), records[5].samples(), "ramps have seeds of their own");
}

#[test]
fn tables_have_a_row_for_each_thing() {
    let (scratch, _) = done(&small_study(), "tables");
    let rows = |name: &str| {
        let mut reader = csv::Reader::from_path(scratch.0.join(name)).unwrap();
        let header = reader.headers().unwrap().clone();
        (header, reader.records().map(Result::unwrap).collect::<Vec<_>>())
    };
    let (header, values) = rows("values.csv");
    assert_eq!(values.len(), 10);
    assert_eq!(
        header.iter().take(5).collect::<Vec<_>>(),
        ["ramp", "value", "leg", "inelasticity", "friction"]
    );
    assert_eq!(values[7].iter().take(5).collect::<Vec<_>>(), ["1", "2", "up", "0.02", "0.3"]);
    // Six samples tell no error: the last column names all that are lower bounds.
    assert_eq!(header.iter().next_back(), Some("not_converged"));
    let all = "one_roll one_roll_magnitude two_rolls height translational_energy rotational_energy \
               vertical_temperature energy_change";
    assert_eq!(values[7].iter().next_back(), Some(all));
    assert_eq!(rows("samples.csv").1.len(), 60);
    assert_eq!(rows("profiles.csv").1.len(), 300);
}

/// A value is as long and as sampled as one made by hand with the engine.
#[test]
fn a_value_is_the_engine_s_run() -> Result<(), AnyError> {
    use granular_edmd::observable::{OrderParameters, SampleTimes, Series};
    let specification = Specification::new(small_system(), Protocol::new(25, 6, 10), 7)?;
    let (_scratch, study) = done(&specification, "engine");
    let record = study.record(0, 0)?.ok_or("no record")?;
    let long = Specification::new(small_system(), Protocol::new(0, 85, 1), 7)?;
    let (_scratch, study) = done(&long, "engine-every");
    let every = study.record(0, 0)?.ok_or("no record")?;
    let thinned: Vec<_> = every.samples().iter().skip(34).step_by(10).map(|sample| sample.one_roll).collect();
    assert_eq!(record.samples().iter().map(|sample| sample.one_roll).collect::<Vec<_>>(), thinned);
    assert_eq!(record.state().to_bytes()?, every.state().to_bytes()?);
    // And from its last state it goes on like any other run.
    let container = granular_edmd::boundary::Container::closed(10.0, 30.0)?.with_motion(
        granular_edmd::boundary::Wall::Floor,
        granular_edmd::wall::BiParabolic::new(0.1, 10.0)?,
    )?;
    let rule = granular_edmd::collision::ContactDuration::new(
        granular_edmd::collision::Frictional::new(0.05, 0.0)?,
        1e-4,
    )?;
    let scheduler = granular_edmd::scheduler::TournamentTree::default();
    let resumption = granular_edmd::Simulation::resume(record.state(), rule, container);
    let mut run = resumption.with_another_rule().scheduler(scheduler).build()?;
    let period = std::f64::consts::TAU / 10.0;
    let times = SampleTimes::every(10.0 * period)?.starting_at(95.0 * period)?;
    let mut series = Series::new(OrderParameters, times);
    run.run_until(95.0 * period, &mut series)?;
    assert_eq!(series.values().len(), 1);
    Ok(())
}

#[test]
fn other_parameters_ramp_and_other_bases_run() -> Result<(), AnyError> {
    let thermal = System::new(30, 10.0, Base::Thermal { temperature: 1.0, slip: false }).with_gravity(0.1);
    let ramps = [
        (small_system(), Parameter::Gravity, vec![0.01, 0.02]),
        (small_system(), Parameter::Amplitude, vec![0.1, 0.2]),
        (small_system(), Parameter::Inelasticity, vec![0.0, 0.1]),
        (thermal, Parameter::Temperature, vec![1.0, 2.0]),
    ];
    for (system, parameter, values) in ramps {
        let ramp = Ramp::new(parameter, values.clone(), Course::Down);
        let specification = Specification::new(system, Protocol::new(5, 3, 5), 1)?.with_ramp(ramp)?;
        let (_scratch, study) = done(&specification, &format!("other-{parameter}"));
        let last = study.record(0, 1)?.ok_or("no record")?;
        assert_eq!(last.system().get(parameter), Some(values[0]));
        assert_eq!(last.outcome(), &Outcome::Completed);
    }
    Ok(())
}

/// Without the contact-duration model a vibrated floor stops lossy disks for good: an outcome, not an end.
#[test]
fn a_stalled_value_does_not_stop_the_study() -> Result<(), AnyError> {
    let system = System::new(30, 10.0, BASE).with_height(30.0).with_gravity(0.5);
    let ramp = Ramp::new(Parameter::Inelasticity, vec![0.0, 0.45], Course::UpAndDown);
    let specification = Specification::new(system, Protocol::new(50, 5, 10), 1)?.with_ramp(ramp)?;
    let (_scratch, study) = done(&specification, "stalled");
    let outcomes: Vec<_> =
        study.records().map(|record| record.map(|r| r.outcome().name())).collect::<Result<_, _>>()?;
    assert_eq!(outcomes, ["completed", "stalled", "completed"]);
    let (before, stalled, after) = (study.record(0, 0)?, study.record(0, 1)?, study.record(0, 2)?);
    let time = |record: &Option<granular_edmd::study::Record>| record.as_ref().map(|r| r.state().time());
    assert_eq!(time(&before), time(&stalled), "the next value starts where this one did");
    assert!(time(&after) > time(&stalled));
    Ok(())
}

#[test]
#[cfg(feature = "rayon")]
fn threads_do_not_matter() -> Result<(), AnyError> {
    let (expected, _) = done(&small_study(), "threads-any");
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let (found, _) = pool.install(|| done(&small_study(), &format!("threads-{threads}")));
        assert_same(&found.0, &expected.0);
    }
    Ok(())
}

#[test]
fn an_interrupted_study_goes_on() -> Result<(), AnyError> {
    let (expected, _) = done(&small_study(), "interrupted-not");
    let scratch = Scratch::new("interrupted");
    let stop = AtomicBool::new(false);
    let last = AtomicU64::new(0);
    let mut runs = 0;
    loop {
        let study = Study::open_or_create(&scratch.0, &small_study())?;
        let steps = AtomicU64::new(0);
        let progress = |progress: &Progress| {
            last.store(progress.done, Ordering::Relaxed);
            if steps.fetch_add(1, Ordering::Relaxed) > 16 {
                stop.store(true, Ordering::Relaxed);
            }
        };
        let control = Control::default().with_interrupt(&stop).with_progress(&progress);
        stop.store(false, Ordering::Relaxed);
        runs += 1;
        if study.run(&control)?.is_complete() {
            break;
        }
    }
    assert!(runs > 2, "it was interrupted");
    assert_eq!(last.into_inner(), 10 * 9, "three steps to settle, six samples");
    assert_same(&scratch.0, &expected.0);
    Ok(())
}

const CHILD_FOLDER: &str = "GRANULAR_EDMD_TEST_STUDY";

/// What a killed process does; on its own it does nothing.
#[test]
#[ignore = "started by the tests of killed processes"]
fn child() {
    let Ok(folder) = std::env::var(CHILD_FOLDER) else { return };
    let study = Study::open_or_create(folder, &small_study()).unwrap();
    study.run(&Control::default().with_save_interval(Duration::ZERO)).unwrap();
}

fn start_child(folder: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "child", "--ignored"])
        .env(CHILD_FOLDER, folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Killed at moments that drift through the run, until it is complete.
#[test]
fn a_killed_study_ends_with_the_same_bytes() {
    let (expected, _) = done(&small_study(), "killed-not");
    let scratch = Scratch::new("killed");
    let mut kills = 0;
    loop {
        let mut child = start_child(&scratch.0);
        std::thread::sleep(Duration::from_millis(20 + 7 * kills));
        match child.try_wait().unwrap() {
            Some(status) => {
                assert!(status.success());
                break;
            }
            None => child.kill().unwrap(),
        }
        child.wait().unwrap();
        kills += 1;
    }
    assert!(kills > 0);
    assert_same(&scratch.0, &expected.0);
}

#[test]
fn damage_is_noticed_named_and_repaired() -> Result<(), AnyError> {
    let (scratch, study) = done(&small_study(), "damaged");
    let expected = contents(&scratch.0);
    let path = scratch.0.join("ramps/0001/0002.record");
    let sound = fs::read(&path)?;
    let flipped = |at: usize| {
        let mut bytes = sound.clone();
        bytes[at] ^= 0x10;
        bytes
    };
    let another = fs::read(scratch.0.join("ramps/0001/0003.record"))?;
    let cut = [0, 7, 10, 40, sound.len() / 2, sound.len() - 1].map(|length| sound[..length].to_vec());
    let changed = [0, 9, 20, 60, sound.len() - 1].map(flipped);
    for bytes in cut.into_iter().chain(changed).chain([another]) {
        fs::write(&path, bytes)?;
        let error = study.record(1, 2).unwrap_err();
        assert!(matches!(&error, StudyError::Damaged { path: named, .. } if *named == path), "{error}");
        assert!(study.records().any(|record| record.is_err()));
        let summary = study.run(&Control::default())?;
        assert!(summary.is_complete());
        assert_eq!(summary.redone, std::slice::from_ref(&path));
        assert!(contents(&scratch.0) == expected);
    }
    let log = fs::read_to_string(scratch.0.join("log.jsonl"))?;
    assert!(log.contains(r#"{"damaged":"0001/0002.record","reason":"its checksum does not match"}"#));
    for line in log.lines() {
        serde_json::from_str::<serde_json::Value>(line)?;
    }
    Ok(())
}

#[test]
fn a_damaged_half_done_value_is_started_again() -> Result<(), AnyError> {
    let (expected, _) = done(&small_study(), "half-done-not");
    let scratch = Scratch::new("half-done");
    let stop = AtomicBool::new(false);
    let progress = |_: &Progress| stop.store(true, Ordering::Relaxed);
    let study = Study::create(&scratch.0, &small_study())?;
    let summary = study.run(&Control::default().with_interrupt(&stop).with_progress(&progress))?;
    assert!(!summary.is_complete());
    let partial = scratch.0.join("ramps/0000/0000.partial");
    let bytes = fs::read(&partial)?;
    fs::write(&partial, &bytes[..bytes.len() / 2])?;
    fs::write(scratch.0.join("ramps/0000").join(TEMPORARY), "of a killed process")?;
    let summary = study.run(&Control::default())?;
    assert_eq!(summary.redone, [partial]);
    assert_same(&scratch.0, &expected.0);
    Ok(())
}

/// Name of a file that a killed process was writing.
const TEMPORARY: &str = "granular-edmd-4711-0-0123456789abcdef.tmp";

#[test]
fn only_temporary_files_of_the_library_are_removed() -> Result<(), AnyError> {
    let scratch = Scratch::new("temporaries");
    let study = Study::create(&scratch.0, &small_study())?;
    fs::create_dir_all(scratch.0.join("ramps/0000"))?;
    let theirs = ["data.tmp", "granular-edmd.tmp", "ramps/0000/0001.record.tmp", "ramps/0000/notes.tmp"];
    for name in theirs {
        fs::write(scratch.0.join(name), name)?;
    }
    for folder in ["", "ramps/0000"] {
        fs::write(scratch.0.join(folder).join(TEMPORARY), "of a killed process")?;
    }
    fs::create_dir(scratch.0.join("granular-edmd-4711-1-0123456789abcdef.tmp"))?;
    assert!(study.run(&Control::default())?.is_complete());
    for name in theirs {
        assert_eq!(fs::read_to_string(scratch.0.join(name))?, name);
    }
    for folder in ["", "ramps/0000"] {
        assert!(!scratch.0.join(folder).join(TEMPORARY).exists(), "{folder}");
    }
    Ok(())
}

#[test]
fn another_process_is_told_to_wait() -> Result<(), AnyError> {
    let scratch = Scratch::new("locked");
    let study = Study::create(&scratch.0, &small_study())?;
    let tries = AtomicU64::new(0);
    let progress = |_: &Progress| {
        let error = Study::open(&scratch.0).and_then(|same| same.run(&Control::default())).unwrap_err();
        assert!(
            matches!(error, StudyError::Locked { process: Some(id), .. } if id == std::process::id()),
            "{error}"
        );
        assert!(error.to_string().contains("is being run by another process"), "{error}");
        let mut child = start_child(&scratch.0);
        assert!(!child.wait().unwrap().success(), "another process runs a study that is being run");
        tries.fetch_add(1, Ordering::Relaxed);
    };
    let stop = AtomicBool::new(false);
    let once = |told: &Progress| {
        if !stop.swap(true, Ordering::Relaxed) {
            progress(told);
        }
    };
    study.run(&Control::default().with_progress(&once).with_interrupt(&stop))?;
    assert_eq!(tries.into_inner(), 1);
    assert!(study.run(&Control::default())?.is_complete(), "the lock is free again");
    Ok(())
}

#[test]
fn folders_that_cannot_be_used_are_named() -> Result<(), AnyError> {
    let scratch = Scratch::new("folders");
    assert!(matches!(Study::open(&scratch.0), Err(StudyError::Missing { .. })));
    let study = Study::create(&scratch.0, &small_study())?;
    assert!(matches!(Study::create(&scratch.0, &small_study()), Err(StudyError::Exists { .. })));
    let other = Specification::new(small_system(), Protocol::new(1, 1, 1), 1)?;
    assert!(matches!(Study::open_or_create(&scratch.0, &other), Err(StudyError::Different { .. })));
    // A file where a folder should be cannot be written into, not even by the superuser.
    fs::write(scratch.0.join("ramps"), "not a folder")?;
    let error = study.run(&Control::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot create"), "{error}");
    assert!(error.to_string().contains("ramps"), "{error}");
    let error = Study::create(scratch.0.join("README.txt"), &small_study()).unwrap_err();
    assert!(matches!(error, StudyError::Io { .. }), "{error}");
    Ok(())
}

#[test]
#[cfg(unix)]
fn a_read_only_folder_is_an_error() -> Result<(), AnyError> {
    use std::os::unix::fs::PermissionsExt;
    let scratch = Scratch::new("read-only");
    let study = Study::create(&scratch.0, &small_study())?;
    fs::set_permissions(&scratch.0, fs::Permissions::from_mode(0o555))?;
    let superuser = fs::write(scratch.0.join("probe"), "").is_ok();
    let result = study.run(&Control::default());
    fs::set_permissions(&scratch.0, fs::Permissions::from_mode(0o755))?;
    if !superuser {
        let error = report(&result.unwrap_err());
        assert!(error.starts_with("cannot write") && error.contains("ermission denied"), "{error}");
    }
    Ok(())
}

#[test]
fn a_changed_specification_takes_no_old_records() -> Result<(), AnyError> {
    let (scratch, _) = done(&small_study(), "changed");
    let before = contents(&scratch.0);
    let path = scratch.0.join("specification.toml");
    fs::write(&path, fs::read_to_string(&path)?.replace("seed = 7", "seed = 8"))?;
    let study = Study::open(&scratch.0)?;
    let error = study.run(&Control::default()).unwrap_err();
    assert!(matches!(error, StudyError::Foreign { .. }), "{error}");
    assert!(error.to_string().contains(".record is of another specification"), "{error}");
    fs::write(&path, &before[Path::new("specification.toml")])?;
    assert!(contents(&scratch.0) == before, "nothing was lost");
    Ok(())
}

const PLAN: &str = r#"
seed = 1

[system]
disks = 30
width = 10.0
height = 30
gravity = 0.015625
friction = 0.01
base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 }

[protocol]
settle = 100
samples = 10
every = 10

[ramp]
parameter = "friction"
values = [0.01, 0.02]

[[sweep]]
parameter = "inelasticity"
values = [0.0, 0.01, 0.01]
"#;

#[test]
fn a_plan_is_read_as_it_is_written() -> Result<(), AnyError> {
    let plan = Specification::from_toml(PLAN)?;
    let by_hand = Specification::new(
        System::new(30, 10.0, BASE).with_height(30.0).with_gravity(0.015_625).with_friction(0.01),
        Protocol::new(100, 10, 10),
        1,
    )?
    .with_ramp(Ramp::new(Parameter::Friction, vec![0.01, 0.02], Course::Up))?
    .with_axis(Axis::new(Parameter::Inelasticity, vec![0.0, 0.01, 0.01]))?;
    assert_eq!(plan, by_hand);
    assert_eq!(Specification::from_toml(&plan.to_string())?, plan);
    assert_eq!((plan.ramps(), plan.values()), (3, 2));
    Ok(())
}

/// A line of a plan, what takes its place, and what the error says.
const REFUSED: [(&str, &str, &str); 19] = [
    ("seed = 1", "seed = 1\nsede = 2", "unknown field `sede`"),
    ("disks = 30", "disks = 30\nmass = 2", "unknown field `mass`"),
    ("disks = 30", "disks = 0", "number of disks must be at least 1, but is 0"),
    ("disks = 30", "disks = 300000", "there is room for"),
    (
        "disks = 30\nwidth = 10.0\nheight = 30",
        "disks = 9000000000000000000\nwidth = 10.0",
        "but is 9000000000000000000",
    ),
    ("disks = 30", "", "missing field `disks`"),
    ("width = 10.0", "width = -10.0", "width must be finite and positive, but is -10"),
    ("height = 30", "height = inf", "height must be finite and positive, but is inf"),
    ("gravity = 0.015625", "gravity = nan", "gravity must be finite, but is NaN"),
    (
        "friction = 0.01",
        "dynamic_friction = 1.5",
        "dynamic friction must be at most the static friction, but is 1.5",
    ),
    ("friction = 0.01", "contact_duration = 0.0", "contact duration must be finite and positive, but is 0"),
    ("amplitude = 0.1", "amplitude = 0.0", "amplitude must be finite and positive, but is 0"),
    ("amplitude = 0.1", "amplitude = 0.1, phase = 2", "unexpected keys in table: phase"),
    ("bi_parabolic", "square", "unknown variant `square`"),
    ("samples = 10", "samples = 0", "number of samples must be in 1..=2^40, but is 0"),
    ("every = 10", "every = 10\nphase = 0.0", "phase of the samples must be in (0, 1], but is 0"),
    ("values = [0.01, 0.02]", "values = [0.02, 0.01]", "friction has 0.01 after 0.02"),
    ("values = [0.0, 0.01, 0.01]", "values = [0.7]", "normal inelasticity must be in [0, 0.5], but is 0.7"),
    ("parameter = \"inelasticity\"", "parameter = \"friction\"", "friction varies twice"),
];

#[test]
fn plans_with_errors_are_refused_by_name() {
    for (line, instead, expected) in REFUSED {
        assert!(PLAN.contains(line));
        let error = Specification::from_toml(&PLAN.replacen(line, instead, 1)).unwrap_err().to_string();
        assert!(error.contains(expected), "{instead}: {error}");
    }
    let ramps = [
        ("friction", "width", "width cannot be ramped"),
        ("friction", "temperature", "the base has no temperature"),
        ("values = [0.01, 0.02]", "values = []", "friction has no values"),
        ("values = [0.01, 0.02]", "values = [0.01, inf]", "a value of friction must be finite, but is inf"),
        (
            "values = [0.01, 0.02]",
            "values = [-1.0]",
            "static friction must be finite and not negative, but is -1",
        ),
    ];
    for (word, instead, expected) in ramps {
        let (head, tail) = PLAN.split_once("[ramp]").unwrap();
        let text = format!("{head}[ramp]{}", tail.replacen(word, instead, 1));
        let error = Specification::from_toml(&text).unwrap_err().to_string();
        assert!(error.contains(expected), "{instead}: {error}");
    }
}

proptest! {
    #![proptest_config(cases::config(64))]

    /// Every number survives the file, to the last bit.
    #[test]
    fn plans_survive_their_file(
        seed in 0..i64::MAX as u64,
        gravity in -1e3..1e3_f64,
        friction in prop::collection::btree_set(0_u64..1 << 52, 1..6),
        course in prop::sample::select(vec![Course::Up, Course::Down, Course::UpAndDown]),
        every in 1_u64..1000,
        phase in 1e-9..=1.0_f64,
    ) {
        let values = friction.into_iter().map(|bits| bits as f64 / 7e15).collect();
        let plan = Specification::new(
            small_system().with_gravity(gravity),
            Protocol::new(3, 5, every).with_phase(phase),
            seed,
        )?
        .with_ramp(Ramp::new(Parameter::Friction, values, course))?;
        prop_assert_eq!(Specification::from_toml(&plan.to_toml()?)?, plan);
    }
}
