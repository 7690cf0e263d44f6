//! The engine: the same bits under any observer and scheduler, exact balances, closed forms, an independent
//! simulation by brute force, and clear errors for what cannot be run.

mod agreement;
mod balances;
mod bouncing;
mod changes;
mod counting;
mod crowds;
mod driving;
mod ends;
mod extremes;
mod inputs;
mod kinds;
mod late_times;
mod limits;
mod long_runs;
mod mixture_oracle;
mod mixtures;
mod odd_settings;
mod oracle;
mod order;
mod parting;
mod partition;
mod periodic;
mod pistons;
mod planted;
mod population;
mod reactions;
mod replays;
mod rest;
#[cfg(feature = "serde")]
mod resuming;
mod rotor;
#[cfg(feature = "serde")]
#[path = "../support/scratch.rs"]
mod scratch;
mod seeds;
mod setups;
mod slopes;
mod steps;
mod stopping;
mod thermal;
mod traffic;
mod warned;
#[cfg(feature = "serde")]
mod whole_files;
