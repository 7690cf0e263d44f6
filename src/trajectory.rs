//! Trajectories written to files for other programs, and disks read from files.
//!
//! A [`Recorder`] is an [`Observer`](crate::observable::Observer) that writes a frame to a file at set times.
//! Its [`Format`] defines the form of a frame. Numbers are written so that they read back to the same bits.
//!
//! | format | file | opened by |
//! |---|---|---|
//! | [`ExtendedXyz`] | one file, frame after frame | OVITO (not ASE), [`XyzFrames`] to start from |
//! | [`LammpsDump`] | one file, frame after frame | OVITO, VMD, tools around LAMMPS |
//! | GSD, as of HOOMD-blue | one binary file with an index ([`Recorder::create_gsd`]) | OVITO, freud, `gsd` |
//! | VTK's `PolyData` | `.vtp` for each frame, `.pvd` for times ([`Recorder::create_vtk`]) | ParaView, VTK |
//!
//! | state in a file | read by | written by |
//! |---|---|---|
//! | extended XYZ | [`State::from_xyz`], [`XyzFrames`] | [`ExtendedXyz`] |
//! | table of comma-separated values | [`State::from_csv`] | [`State::write_csv`] |
//! | data file of LAMMPS, `atom_style sphere` | [`State::from_lammps_data`] | [`State::write_lammps_data`] |
//! | VTK's `PolyData` | | [`State::write_vtk`] |
//!
//! With the feature `gzip`, a trajectory is compressed if the name of its file ends in `.gz`.
//!
//! # Record a run
//! ```
//! use granular_edmd::prelude::*;
//! use granular_edmd::trajectory::{ExtendedXyz, Recorder, State, read};
//!
//! # let folder = std::env::temp_dir().join(format!("granular-edmd-trajectory-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! # let path = folder.join("run.xyz");
//! let container = Container::closed(20.0, 30.0)?;
//! let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 50, 0.5)?, 0.5, 42)?;
//! let rule = Frictional::from_inelasticity(0.01, 0.01, 0.1)?;
//! let mut run = Simulation::builder(rule, container.clone()).disks(disks).build()?;
//!
//! // Let `path` be "run.xyz". An existing file is never overwritten.
//! let mut recorder = Recorder::create(&path, ExtendedXyz, SampleTimes::every(0.5)?)?;
//! run.run_until(2.0, &mut recorder)?;
//! assert_eq!(recorder.times(), [0.5, 1.0, 1.5, 2.0]);
//!
//! // The last frame is the state of the disks, to the bit.
//! let state = read(&path, State::from_xyz)?;
//! assert_eq!(state.disks(), run.disks());
//! let again = Simulation::builder(Frictional::from_inelasticity(0.01, 0.01, 0.1)?, container)
//!     .starting_at(state.time().unwrap_or(0.0))
//!     .disks(state.into_disks())
//!     .build()?;
//! assert_eq!(again.time(), 2.0);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A format of your own
//! In a plain test, [`laws::check`] checks the contract of a format.
//!
//! ```
//! use std::io::{self, BufRead, Write};
//! use granular_edmd::boundary::Domain;
//! use granular_edmd::observable::Snapshot;
//! use granular_edmd::trajectory::{Format, Frame};
//!
//! /// A line for each frame: the time, and the height of each disk.
//! struct Heights;
//!
//! impl Format for Heights {
//!     fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
//!         write!(out, "{:?}", frame.snapshot().time())?;
//!         frame.snapshot().disks().iter().try_for_each(|disk| write!(out, " {:?}", disk.position().y))?;
//!         writeln!(out)
//!     }
//! }
//!
//! granular_edmd::trajectory::laws::check(&Heights).unwrap();
//! let snapshot = Snapshot::new(0.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0);
//! let mut text = Vec::new();
//! Heights.write_frame(&Frame::new(0, &snapshot), &mut text)?;
//! assert_eq!(text, b"0.5\n");
//! # Ok::<(), io::Error>(())
//! ```

mod csv;
mod entry;
mod errors;
mod extended_xyz;
mod format;
mod frames;
mod gsd;
#[cfg(feature = "gzip")]
mod gzip;
mod lammps_data;
mod lammps_dump;
pub mod laws;
mod lines;
mod media;
mod one_file;
mod open;
mod overlap;
mod recorder;
mod state;
mod store;
mod vtk;

pub use errors::{ReadError, RecordError};
#[doc(alias = "OVITO")]
pub use extended_xyz::{ExtendedXyz, XyzFrames};
pub use format::{Format, Frame};
#[doc(alias("OVITO", "VMD"))]
pub use lammps_dump::LammpsDump;
pub use open::{open, read};
#[doc(alias("dump", "movie"))]
pub use recorder::Recorder;
#[doc(alias("read_data", "initial condition"))]
pub use state::State;
