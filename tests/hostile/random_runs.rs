//! Random systems under random scripts. The laws hold after each event, and the bits are the same under every
//! scheduler and through every checkpoint.

use proptest::prelude::*;

use crate::script::{Actor, script};
use crate::systems::system;
use support::cases::config;
use support::schedulers::SCHEDULERS;

proptest! {
    #![proptest_config(config(160))]

    #[test]
    fn the_laws_hold_and_the_bits_agree(system in system(), script in script()) {
        let first = Actor::new(&system, 0, false).perform(&script)?;
        for scheduler in 1..SCHEDULERS.len() {
            let other = Actor::new(&system, scheduler, false).perform(&script)?;
            agree(&first, &other)?;
        }
        agree(&first, &Actor::new(&system, 0, true).perform(&script)?)?;
    }
}

fn agree(one: &Actor, other: &Actor) -> Result<(), TestCaseError> {
    let differ = one.trace.iter().zip(&other.trace).position(|(a, b)| a != b);
    prop_assert!(differ.is_none(), "traces part at frame {differ:?}");
    prop_assert_eq!(one.trace.len(), other.trace.len());
    prop_assert_eq!(&one.end, &other.end);
    Ok(())
}
