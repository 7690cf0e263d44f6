//! Parts that the examples share: the command line, progress, the results, the mean flow, and panels on a
//! sheet.
#![allow(dead_code, reason = "each example takes what it needs")]

pub(crate) mod command_line;
pub(crate) mod flow;
pub(crate) mod progress;
pub(crate) mod results;
pub(crate) mod sheet;
