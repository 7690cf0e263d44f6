//! Parts that the programs of the gallery share: the command line, progress, the results, and pictures: disks
//! and mean flow, looks of series, panels on a sheet, and the sheet as a file.
#![allow(clippy::missing_errors_doc, reason = "each program ends with the error that it gets")]

pub mod command_line;
pub mod faces;
pub mod failure;
pub mod flow;
pub mod legend;
pub mod letters;
pub mod look;
pub mod output;
pub mod palette;
pub mod panel;
pub mod paper;
pub mod progress;
pub mod raster;
pub mod results;
pub mod runs;
pub mod sheet;
#[cfg(feature = "studies")]
pub mod studies;
