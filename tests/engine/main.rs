//! The engine: the same bits whoever watches and schedules, exact balances, closed forms, an independent simulation by
//! brute force, and clear errors for what cannot be run.

mod agreement;
mod balances;
mod bouncing;
#[path = "../support/cases.rs"]
mod cases;
mod changes;
mod inputs;
mod late_times;
mod lies;
mod long_runs;
mod oracle;
mod parting;
mod setups;
mod steps;
mod thermal;
