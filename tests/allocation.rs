//! A test that the event loop allocates nothing, with an allocator that counts.
//!
//! Only a change of the size of the cells allocates, when the state has become denser or more dilute. Dense
//! and dilute runs that have settled have no such change.

// An allocator cannot be written without unsafe code. This one passes every call on to that of the system.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

use granular_edmd::observable::EnergyChange;
use granular_edmd::prelude::*;

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: every call goes to the system's allocator with the arguments that came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A single test covers both runs, since all tests share the counter.
#[test]
fn settled_runs_allocate_nothing() -> Result<(), Box<dyn std::error::Error>> {
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
