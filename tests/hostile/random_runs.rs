//! Random systems under random scripts. The laws hold after each event, and the bits are the same under every
//! scheduler and through every checkpoint.

use std::panic::resume_unwind;
use std::thread;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use crate::script::{Actor, script};
use crate::systems::system;
use support::cases::config;
use support::schedulers::SCHEDULERS;

/// Unoptimized, a random system with its script takes more room than the stack of a test has.
const STACK: usize = 32 << 20;

#[test]
fn the_laws_hold_and_the_bits_agree() {
    let runs = || {
        let outcome = TestRunner::new(config(40)).run(&(system(), script()), |(system, script)| {
            let first = Actor::new(&system, 0, false).perform(&script)?;
            for scheduler in 1..SCHEDULERS.len() {
                let other = Actor::new(&system, scheduler, false).perform(&script)?;
                agree(&first, &other)?;
            }
            agree(&first, &Actor::new(&system, 0, true).perform(&script)?)
        });
        outcome.map_err(|found| found.to_string())
    };
    let thread = thread::Builder::new().stack_size(STACK).spawn(runs).expect("a thread");
    let outcome = thread.join().unwrap_or_else(|panic| resume_unwind(panic));
    outcome.unwrap_or_else(|found| panic!("{found}"));
}

fn agree(one: &Actor, other: &Actor) -> Result<(), TestCaseError> {
    let differ = one.trace.iter().zip(&other.trace).position(|(a, b)| a != b);
    prop_assert!(differ.is_none(), "traces part at frame {differ:?}");
    prop_assert_eq!(one.trace.len(), other.trace.len());
    prop_assert_eq!(&one.end, &other.end);
    Ok(())
}
