//! What several targets of the tests share.
#![allow(clippy::missing_panics_doc, reason = "a test may panic")]

pub mod cases;
pub mod measured;
pub mod report;
pub mod schedulers;
pub mod table;
