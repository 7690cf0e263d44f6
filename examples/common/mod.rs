//! What the examples share: reading the command line, the mean flow, putting panels on a sheet.
#![allow(dead_code, reason = "each example takes what it needs")]

pub(crate) mod command_line;
pub(crate) mod flow;
pub(crate) mod sheet;
