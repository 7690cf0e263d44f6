//! Files of disks: what is written reads back to the same bits, nothing is lost when a disk is full or a
//! process is killed, and every fault of a file is told with its line.

#[path = "../support/report.rs"]
mod report;

mod faults;
mod recording;
mod round_trips;
mod scratch;
mod states;
mod vtk;
