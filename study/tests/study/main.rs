//! Studies: the plan as data, the same bytes however they come about, and damage that is noticed.

mod damage;
mod folders;
mod growth;
mod identity;
mod interruption;
#[path = "../support/logs.rs"]
mod logs;
#[path = "../support/mixture.rs"]
mod mixture;
mod own;
mod paths;
mod pistons;
mod plans;
mod processes;
mod random;
mod refinement;
mod riders;
mod support;
mod tables;
mod values;
mod watched;
