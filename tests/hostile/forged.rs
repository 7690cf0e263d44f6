//! Checkpoints whose checksum is right and whose contents are wrong. Each is refused, or is a state that runs
//! on.
//!
//! The system limits what a forged state may cost: this test runs itself in a process with little memory and
//! time.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::{Checkpoint, CheckpointError};
use granular_edmd::{Disk, Simulation};

use crate::forged_systems::{Run, SYSTEMS, System};
use crate::forging::{LITTLE, STRIDE, forged, none_panics, patterns, stride};
use crate::limits::{Limits, in_child};
use crate::specimens::{CONTENTS_AT, checkpoint, sealed};

/// Variable with the number of events for which each run goes on.
const EVENTS: &str = "GRANULAR_EDMD_HOSTILE_EVENTS";

/// Variable with the only system that is forged.
const ONLY: &str = "GRANULAR_EDMD_HOSTILE_ONLY";

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
fn forged_checkpoints_are_refused_or_run() {
    in_child("forged::forged_checkpoints", &LITTLE, &[(STRIDE, "997"), (EVENTS, "300")]).assert_success();
}

#[test]
#[ignore = "an hour: all of them"]
fn all_forged_checkpoints_are_refused_or_run() {
    let limits = Limits { seconds: 20_000, ..LITTLE };
    in_child("forged::forged_checkpoints", &limits, &[]).assert_success();
}
