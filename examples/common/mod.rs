//! Parts that the examples share: the command line, progress, the results, and pictures: disks and mean flow,
//! looks of series, panels on a sheet, and the sheet as a file.
#![allow(dead_code, reason = "each example takes what it needs")]

pub(crate) mod command_line;
pub(crate) mod faces;
pub(crate) mod flow;
pub(crate) mod look;
pub(crate) mod panel;
pub(crate) mod paper;
pub(crate) mod progress;
pub(crate) mod raster;
pub(crate) mod results;
pub(crate) mod sheet;
