//! Files whose checksum is right and whose contents are wrong. Each is refused, or is a state that runs on.
//!
//! The system limits what a forged state may cost: this test runs itself in a process with little memory and
//! time.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, Once};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{Checkpoint, CheckpointError};
use granular_edmd::study::vibrated_box::Sample;
use granular_edmd::study::{Control, Experiment, Plan, Record, Study};
use granular_edmd::{Disk, Simulation};

use crate::forged_systems::{Run, SYSTEMS, System};
use crate::limits::{Limits, in_child};
use crate::specimens::{
    CONTENTS_AT, checkpoint, done_study, own_plan, plan, resume, run_steps, sealed, stopped_study,
};

/// Returns the bytes that are written over the contents at each place: floats, and lengths and indices in
/// their encoding.
fn patterns() -> Vec<Vec<u8>> {
    let floats = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        -1.0,
        -0.0,
        0.5,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        1e-30,
        1e60,
    ];
    let floats = floats.iter().map(|float| float.to_le_bytes().to_vec());
    let varints = [u64::MAX, 1 << 32, u64::from(u32::MAX), 1000].map(varint);
    let bytes = [0, 1, 2, 3, 4, 5, 0x7f, 0x80, 0xff].map(|byte| vec![byte]);
    floats.chain(varints).chain(bytes).collect()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// The file with each pattern at each `stride`-th place of its contents, under a right checksum.
fn forged(file: &[u8], stride: usize) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let contents = &file[CONTENTS_AT..];
    let places = (0..contents.len()).flat_map(|place| patterns().into_iter().map(move |with| (place, with)));
    let files = places.flat_map(|(place, with)| {
        // The pattern replaces as many bytes, or a single one, as a longer length would.
        [place + with.len(), place + 1].map(|end| {
            let rest = &contents[end.min(contents.len())..];
            (place, sealed(file, &[&contents[..place], &with, rest].concat()))
        })
    });
    files.step_by(stride)
}

static CASE: AtomicUsize = AtomicUsize::new(0);

/// The file that is tried.
static TRIED: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Ends the process with a message if one case takes too long, and leaves the file.
fn watch() {
    static STARTED: Once = Once::new();
    let watch = || {
        loop {
            let case = CASE.load(Ordering::Relaxed);
            std::thread::sleep(std::time::Duration::from_secs(20));
            if CASE.load(Ordering::Relaxed) == case {
                let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hanging-file");
                let _ = fs::write(&path, &*TRIED.lock().unwrap());
                eprintln!("case {case} hangs: {}", path.display());
                std::process::abort();
            }
        }
    };
    STARTED.call_once(|| drop(std::thread::spawn(watch)));
}

/// Does all cases, and names each panic once.
fn none_panics(cases: impl Iterator<Item = (usize, Vec<u8>)>, mut check: impl FnMut(&[u8])) {
    watch();
    let mut panics = BTreeMap::new();
    for (place, bytes) in cases {
        CASE.fetch_add(1, Ordering::Relaxed);
        TRIED.lock().unwrap().clone_from(&bytes);
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| check(&bytes))) {
            let said = panic.downcast_ref::<String>().cloned();
            let said = said.or_else(|| panic.downcast_ref::<&str>().map(|&said| said.to_owned()));
            panics.entry(said.unwrap_or_default()).or_insert(place);
        }
    }
    assert!(panics.is_empty(), "panics, with the first place of each: {panics:#?}");
}

/// Variable with the stride: one of this many forged files is tried.
const STRIDE: &str = "GRANULAR_EDMD_HOSTILE_STRIDE";

/// Variable with the number of events for which each run goes on.
const EVENTS: &str = "GRANULAR_EDMD_HOSTILE_EVENTS";

/// Variable with the only system that is forged.
const ONLY: &str = "GRANULAR_EDMD_HOSTILE_ONLY";

fn stride() -> usize {
    std::env::var(STRIDE).map_or(1, |stride| stride.parse().unwrap())
}

const LITTLE: Limits = Limits { memory_kib: 1 << 20, seconds: 600, file_kib: None };

#[test]
fn bytes_behind_a_checkpoint_are_refused() {
    let file = checkpoint().to_bytes().unwrap();
    let longer = sealed(&file, &[&file[CONTENTS_AT..], &[0]].concat());
    let error = Checkpoint::from_bytes(&longer).unwrap_err();
    assert!(error.to_string().contains("something follows it"), "{error}");
}

/// The cells at walls reach to infinity. A disk that is deep in a wall, and fast, would take ages to come
/// back.
#[test]
fn a_disk_beyond_a_wall_is_refused() {
    let place = DVec2::new(1.234_567, 2.345_678);
    let disk = Disk::new(place, 0.5).unwrap().with_velocity(DVec2::ONE).unwrap();
    let walls = || Container::closed(5.0, 4.0).unwrap();
    let file =
        Simulation::builder(Elastic, walls()).disks([disk]).build().unwrap().checkpoint().to_bytes().unwrap();
    for (from, to) in
        [(place.x, -1.0), (place.x, 1e15), (place.y, -1e15), (place.y, 4.6), (place.y, f64::NAN)]
    {
        let contents = &file[CONTENTS_AT..];
        let at = contents.windows(8).position(|bytes| bytes == from.to_le_bytes()).unwrap();
        let forged = sealed(&file, &[&contents[..at], &to.to_le_bytes(), &contents[at + 8..]].concat());
        let error = Simulation::resume(&Checkpoint::from_bytes(&forged).unwrap(), Elastic, walls())
            .build()
            .unwrap_err();
        assert!(matches!(error, CheckpointError::Inconsistent(_)), "{from} {to}: {error}");
    }
}

/// Returns the file with a few places overwritten: by patterns, by other parts of it, and by numbers near
/// those that were there.
fn edited(file: &[u8], seed: u64) -> Vec<u8> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut contents = file[CONTENTS_AT..].to_vec();
    for _ in 0..random.random_range(1..4) {
        let place = random.random_range(0..contents.len());
        let end = (place + 8).min(contents.len());
        match random.random_range(0..4) {
            0 => {
                let patterns = patterns();
                let with = &patterns[random.random_range(0..patterns.len())];
                let end = (place + with.len()).min(contents.len());
                contents.splice(place..end, with.iter().copied());
            }
            1 => {
                let from = random.random_range(0..contents.len() - 8);
                contents.copy_within(from..from + end - place, place);
            }
            2 => contents[place] ^= 1 << random.random_range(0..8),
            _ => {
                let number = 10_f64.powf(random.random_range(-40.0..62.0)) * [1.0, -1.0][place % 2];
                contents.splice(place..end, number.to_le_bytes());
            }
        }
    }
    sealed(file, &contents)
}

/// Returns a time in which no disk goes far, so that a step in it does not take many epochs, whatever a
/// forged disk is like.
fn short_while(disks: &[Disk], gravity: f64) -> f64 {
    let diameter = disks.iter().map(|disk| 2.0 * disk.radius()).fold(f64::INFINITY, f64::min);
    let speed = disks.iter().map(|disk| disk.velocity().length()).fold(0.0, f64::max);
    let way = 100.0 * diameter;
    (way / (speed + (gravity.abs() * way).sqrt())).min(1.0)
}

/// Does this many events of a forged state, if it is one, and takes it to other walls and another gravity.
fn run_on(mut run: Run, events: usize) -> bool {
    for _ in 0..events {
        let end = run.time() + short_while(&run.disks(), run.gravity().strength());
        if run.step_until(end, &mut ()).is_err() {
            break;
        }
    }
    run.checkpoint().to_bytes().is_ok()
}

fn forge(system: &System, cases: impl Iterator<Item = (usize, Vec<u8>)>, events: usize) {
    let (mut accepted, mut tried) = (0, 0);
    none_panics(cases, |bytes| {
        tried += 1;
        let Ok(checkpoint) = Checkpoint::from_bytes(bytes) else { return };
        let runs = [system.resume(&checkpoint), system.resume_elsewhere(&checkpoint)];
        accepted += runs.into_iter().flatten().map(|run| usize::from(run_on(run, events))).sum::<usize>();
    });
    println!("{}: {accepted} runs of {tried} files", system.name);
}

#[test]
#[ignore = "started by the test of forged checkpoints"]
fn forged_checkpoints() {
    let stride = stride();
    let events = std::env::var(EVENTS).map_or(3000, |events| events.parse().unwrap());
    let only = std::env::var(ONLY).ok();
    for system in SYSTEMS.iter().filter(|system| only.as_ref().is_none_or(|only| only == system.name)) {
        let file = system.checkpoint().to_bytes().unwrap();
        forge(system, forged(&file, stride), events);
        let seeds = 0..(patterns().len() * 2 * file.len() / stride) as u64;
        forge(system, seeds.map(|seed| (seed as usize, edited(&file, seed))), events);
    }
}

#[test]
#[ignore = "started by the test of forged records"]
fn forged_records() {
    forge_records("forged", &plan(), |record| {
        let quantity = |sample: &Sample| sample.height;
        let _ = (record.mean(quantity), record.energy_change(), record.thermal_noise(), record.order());
        let _ = (
            record.densest_layer(),
            record.profile().count(),
            record.checkpoint().map(granular_edmd::simulation::Checkpoint::time),
        );
        let _ = record.checkpoint().map(resume);
    });
    forge_records("forged-own", &own_plan(), |record| {
        let _ = (record.mean(|sample| sample.angular_momentum), record.estimate("risen"), record.observer());
    });
}

/// Reads all forgeries of a record; what is accepted is looked at, and takes part in the study.
fn forge_records<E: Experiment>(name: &str, plan: &Plan<E>, look: impl Fn(&Record<E>)) {
    let (scratch, study) = done_study(name, plan);
    let path = scratch.0.join("ramps/0000/0001.record");
    let file = fs::read(&path).unwrap();
    none_panics(forged(&file, stride()), |bytes| {
        fs::write(&path, bytes).unwrap();
        let Ok(Some(record)) = study.record(0, 1) else { return };
        look(&record);
        // All values have records, so this call reads them and writes tables.
        let _ = Study::<E>::open(&scratch.0).unwrap().run(&Control::default().with_verification());
    });
}

#[test]
#[ignore = "started by the test of forged values half done"]
fn forged_partials() {
    forge_partials("forged-partials", &plan());
    forge_partials("forged-own-partials", &own_plan());
}

fn forge_partials<E: Experiment>(name: &str, plan: &Plan<E>) {
    let (scratch, study) = stopped_study(name, plan, 8);
    let path = scratch.0.join("ramps/0000/0001.partial");
    let file = fs::read(&path).unwrap();
    none_panics(forged(&file, stride()), |bytes| {
        fs::write(&path, bytes).unwrap();
        match run_steps(&study, 8) {
            Ok(summary) => assert!(summary.redone.iter().all(|redone| *redone == path)),
            Err(error) => assert!(error.to_string().contains("0001.partial"), "{error}"),
        }
    });
}

#[test]
fn forged_values_half_done_are_started_again_or_go_on() {
    in_child("forged::forged_partials", &LITTLE, &[(STRIDE, "101")]).assert_success();
}

#[test]
#[ignore = "minutes: many more of them"]
fn all_forged_values_half_done_are_started_again_or_go_on() {
    in_child("forged::forged_partials", &LITTLE, &[(STRIDE, "3")]).assert_success();
}

#[test]
fn forged_checkpoints_are_refused_or_run() {
    in_child("forged::forged_checkpoints", &LITTLE, &[(STRIDE, "997"), (EVENTS, "300")]).assert_success();
}

#[test]
#[ignore = "an hour: all of them"]
fn all_forged_checkpoints_are_refused_or_run() {
    let limits = Limits { seconds: 20_000, ..LITTLE };
    in_child("forged::forged_checkpoints", &limits, &[]).assert_success();
}

#[test]
fn forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "401")]).assert_success();
}

#[test]
#[ignore = "minutes: many more of them"]
fn all_forged_records_are_refused_or_read() {
    in_child("forged::forged_records", &LITTLE, &[(STRIDE, "5")]).assert_success();
}
