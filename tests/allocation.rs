//! Tests that the event loop allocates nothing, that disks which come and go leave no memory behind, and that
//! readers need no more memory than a few times their file, with an allocator that counts.
//!
//! Only a change of the size of the cells allocates, when the state has become denser or more dilute. Dense
//! and dilute runs that have settled have no such change.

// An allocator cannot be written without unsafe code. This one passes every call on to that of the system.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use granular_edmd::boundary::{Container, Domain, Part};
use granular_edmd::collision::LeastRebound;
use granular_edmd::observable::EnergyChange;
use granular_edmd::prelude::*;
use granular_edmd::simulation::Inlet;
use granular_edmd_files::{Gsd, Reader, Recorder};

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

/// Bytes that are allocated now, and the most of them since the start of a measurement.
static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// All tests share the counters, so one waits for the other.
static TURN: Mutex<()> = Mutex::new(());

fn grow(size: usize) {
    ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
    PEAK.fetch_max(LIVE.fetch_add(size, Ordering::Relaxed) + size, Ordering::Relaxed);
}

// SAFETY: every call goes to the system's allocator with the arguments that came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // The old bytes may be there until the new ones are filled.
        grow(size);
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn settled_runs_allocate_nothing() -> Result<(), Box<dyn std::error::Error>> {
    let _turn = TURN.lock()?;
    for (inelasticity, friction) in [(0.05, 0.1), (0.0, 0.01)] {
        let container =
            Container::closed(30.0, 60.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
        let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 300, 0.5)?, 0.5, 1)?;
        let rule =
            ContactDuration::new(Frictional::from_inelasticity(inelasticity, inelasticity, friction)?, 1e-4)?;
        let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
        let mut energy = EnergyChange::default();
        simulation.run_until(300.0, &mut energy)?;

        let (before, collisions) =
            (ALLOCATIONS.load(Ordering::Relaxed), simulation.counters().disk_collisions);
        simulation.run_until(500.0, &mut energy)?;
        assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before, "friction {friction}");
        assert!(simulation.counters().disk_collisions > collisions + 1000, "there was something to do");
    }
    Ok(())
}

/// Returns a silo whose grains, of three sizes, come back above when they have left.
fn silo() -> Result<Simulation<LeastRebound<Frictional>, Container>, Box<dyn std::error::Error>> {
    let line = |from: f64, to: f64, y: f64| Part::polyline([DVec2::new(from, y), DVec2::new(to, y)]);
    let vessel = Container::open(12.0)?
        .with_part("left half", line(-1.0, 4.0, 4.0)?)?
        .with_part("right half", line(8.0, 13.0, 4.0)?)?
        .with_part("exit", line(-1.0, 13.0, 1.0)?.absorbing_centers())?;
    let grain = |k: u32| {
        let place = DVec2::new(0.5 + f64::from(k % 12), 5.0 + f64::from(k / 12));
        let moving = DVec2::new(0.1 * libm::sin(f64::from(k)), 0.0);
        Disk::new(place, [0.3, 0.4, 0.45][k as usize % 3])?.with_velocity(moving)
    };
    let grains = (0..96).map(grain).collect::<Result<Vec<_>, _>>()?;
    let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.4)?, 0.2)?;
    let mut silo = Simulation::builder(rule, vessel).gravity(1.0).disks(grains).build()?;
    let places = [DVec2::new(1.0, 16.0), DVec2::new(11.0, 22.0)];
    let times = SampleTimes::every(0.25)?;
    silo.add_inlet(Inlet::refill(places, DVec2::new(0.0, -2.0), times, 5)?)?;
    Ok(silo)
}

#[test]
fn disks_that_come_and_go_leave_no_memory_behind() -> Result<(), Box<dyn std::error::Error>> {
    let _turn = TURN.lock()?;
    let before = LIVE.load(Ordering::Relaxed);
    let (mut silo, mut memory) = (silo()?, Vec::with_capacity(1000));
    while silo.counters().removals < 5000 {
        silo.run_until(silo.time() + 50.0, &mut ())?;
        memory.push(LIVE.load(Ordering::Relaxed) - before);
    }
    let (first, most) = (memory[memory.len() / 4], memory.iter().copied().max().unwrap_or_default());
    assert!(memory.len() > 8 && most <= 2 * first, "the memory is bounded: {first} {most}");
    Ok(())
}

/// Returns a file of GSD with a frame of disks.
fn gsd(count: usize) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let place = |n: usize| DVec2::new((n % 200) as f64 + 0.5, (n / 200) as f64 + 0.5);
    let disks: Vec<Disk> = (0..count).map(|n| Disk::new(place(n), 0.45)).collect::<Result<_, _>>()?;
    let path = std::env::temp_dir().join(format!("granular-edmd-allocation-{}.gsd", std::process::id()));
    let snapshot = Snapshot::new(1.0, &disks, Domain::new(0.0, 200.0, 0.0, 200.0), 1.0);
    Recorder::create(&path, Gsd, SampleTimes::every(1.0)?)?.record(&snapshot)?;
    let bytes = std::fs::read(&path)?;
    std::fs::remove_file(&path)?;
    Ok(bytes)
}

/// No number in a file makes the reader take memory, only its bytes do.
#[test]
fn a_reader_takes_ten_times_its_file_at_most() -> Result<(), Box<dyn std::error::Error>> {
    let _turn = TURN.lock()?;
    let count = 20_000;
    let rows = |start: &str, row: fn(usize) -> String| {
        let mut text = start.to_owned();
        (0..count).for_each(|number| writeln!(text, "{}", row(number)).unwrap());
        text
    };
    let dump = format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS pp pp pp\n0 200\n0 200\n0 1\n\
         ITEM: ATOMS id type x y vx vy radius\n"
    );
    let texts = [
        rows("id,x,y,vx,vy,radius\n", |n| format!("{n},{}.125,{}.375,0.25,-1.5,0.5", n % 200, n / 200)),
        rows(&dump, |n| format!("{n} 1 {}.125 {}.375 0.25 -1.5 0.5", n % 200, n / 200)),
        rows(&format!("{count}\nProperties=species:S:1:pos:R:3:radius:R:1\n"), |n| {
            format!("name{n} {}.125 {}.375 0.0 0.5", n % 200, n / 200)
        }),
        rows(&format!("title\n\n{count} atoms\n0 200 xlo xhi\n0 200 ylo yhi\n\nAtoms # sphere\n\n"), |n| {
            format!("{n} 1 1.0 1.25 {}.125 {}.375 0.0", n % 200, n / 200)
        }),
        // On one heap.
        rows("id,x,y,vx,vy,radius\n", |n| format!("{n},1.125,2.375,0.25,-1.5,0.5")),
        "18446744073709551615\nProperties=pos:R:2:radius:R:1\n1 1 0.5\n".repeat(1000),
    ];
    for text in texts.into_iter().map(String::into_bytes).chain([gsd(count)?]) {
        let before = LIVE.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        let disks = Reader::new().read_from(text.as_slice()).map(|state| state.disks().len());
        let (taken, most) = (PEAK.load(Ordering::Relaxed) - before, 10 * text.len() + 100_000);
        assert!(taken < most, "{taken} bytes for {}: {disks:?}, {:?}", text.len(), text.first_chunk::<20>());
    }
    Ok(())
}
