//! Files of disks: they read back to the same bits, lose nothing when a drive is full or a process is killed,
//! and every fault of a file is reported with its line.

mod corpus;
mod corpus_data;
mod corpus_dumps;
mod corpus_files;
mod corpus_kinds;
mod corpus_notes;
mod corpus_xyz;
#[path = "../../../tests/support/edits.rs"]
mod edits;
mod faults;
mod gsd;
mod meanings;
mod recording;
mod round_trips;
#[path = "../../../tests/support/scratch.rs"]
mod scratch;
mod states;
mod texts;
mod vtk;
