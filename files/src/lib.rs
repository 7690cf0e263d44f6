//! Files of [`granular_edmd`]: trajectories written for other programs, and disks read from their files.
//!
//! A [`Recorder`] is an [`Observer`](granular_edmd::observable::Observer) that writes a frame to a file at
//! set times.
//! Its [`Format`] defines the form of a frame. Numbers are written so that they read back to the same bits.
//!
//! | format | file | opened by |
//! |---|---|---|
//! | [`ExtendedXyz`] | one file, frame after frame | OVITO, ASE, chemfiles, MDAnalysis |
//! | [`LammpsDump`] | one file, frame after frame | OVITO, VMD, MDAnalysis, tools around LAMMPS |
//! | [`Gsd`], the format of HOOMD-blue | one binary file with an index | OVITO, freud, `gsd` |
//! | [`Vtk`], as `PolyData` | `.vtp` for each frame, `.pvd` for times | ParaView, VTK |
//!
//! A [`Reader`] reads all of these formats except VTK, and files of other programs: it recognizes the format
//! by the contents, and columns by their names. A [`State`] holds the disks of a file or of a snapshot. It
//! can be written as a table ([`State::write_csv`]), a data file of LAMMPS ([`State::write_lammps_data`]) or
//! a file of VTK ([`State::write_vtk`]).
//!
//! With the feature `gzip`, a trajectory is compressed if the name of its file ends in `.gz`, and compressed
//! files of any name are read.
//!
//! # Record a run
//! ```
//! use granular_edmd::prelude::*;
//! use granular_edmd_files::{ExtendedXyz, Reader, Recorder};
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
//! let state = Reader::new().read(&path)?;
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
//! # Custom formats
//! [`FrameFormat`] has the contract of a custom format.
//!
//! ```
//! use std::io::{self, BufRead, Write};
//! use granular_edmd::boundary::Domain;
//! use granular_edmd::observable::Snapshot;
//! use granular_edmd_files::{Frame, FrameFormat};
//!
//! /// A line for each frame: the time, and the height of each disk.
//! struct Heights;
//!
//! impl FrameFormat for Heights {
//!     fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
//!         write!(out, "{:?}", frame.snapshot().time())?;
//!         frame.snapshot().disks().iter().try_for_each(|disk| write!(out, " {:?}", disk.position().y))?;
//!         writeln!(out)
//!     }
//! }
//!
//! let snapshot = Snapshot::new(0.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0);
//! let mut text = Vec::new();
//! Heights.write_frame(&Frame::new(0, &snapshot), &mut text)?;
//! assert_eq!(text, b"0.5\n");
//! # Ok::<(), io::Error>(())
//! ```
//!
//! The chapters of the [`guide`] show how to use the files in other programs.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod checks;
mod column;
mod csv;
mod disks;
mod errors;
mod extended_xyz;
mod format;
mod gsd;
pub mod guide;
mod lammps_data;
mod lammps_dump;
mod lines;
mod one_file;
mod reader;
mod recorder;
mod recording;
mod state;
mod table;
mod vtk;

pub use errors::{ReadError, RecordError};
#[doc(alias = "OVITO")]
pub use extended_xyz::ExtendedXyz;
pub use format::{Frame, FrameFormat};
#[doc(alias("OVITO", "VMD"))]
pub use lammps_dump::LammpsDump;
#[doc(alias("read_data", "read_dump", "initial condition"))]
pub use reader::{Reader, States};
#[doc(alias("dump", "movie"))]
pub use recorder::Recorder;
#[doc(alias("OVITO", "freud", "ParaView"))]
pub use recorder::{ByEnding, Format, Gsd, Vtk};
pub use state::State;
