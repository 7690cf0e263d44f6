//! Studies: many runs, planned as data and kept in a folder, which you can watch, stop, resume and spread
//! over processes.
//!
//! An [`Experiment`] is the system under study. It is your own serializable type: its fields are the
//! parameters, and its methods define the simulation, the measurements, and the columns of the tables. A
//! [`Plan`] says which runs to do with the experiment. A [`Protocol`] says when to sample, a [`Ramp`] takes
//! one parameter up or down, each [`Axis`] adds a dimension to a grid of independent ramps, and each point of
//! the grid may be repeated. A [`Study`] is a plan in a folder. [`Study::run`] runs the values that are
//! missing, on all cores and in any number of processes. Each finished value is written immediately, as a
//! [`Record`].
//!
//! The paper's system is an experiment like any other: [`vibrated_box`]. With the feature `cli`, which is on
//! by default, the command `granular-edmd` runs studies of the vibrated box, and [`cli`] makes such a command
//! for a custom experiment. The chapter [`guide::sweep_it`] shows all that a study can do.
//!
//! # Promises
//! 1. A value is a function of its parameters, the values before it in its ramp, its repeat and the seed. The
//!    tables and the records of a complete study have the same bytes for any number of threads and processes,
//!    however often these were interrupted or killed, and whether the study was run in one go or has grown
//!    ([`Control::with_earlier_studies`]). Only wall-clock times and the order of the records in a log
//!    differ. A value that [`Control::with_most_seconds`] ended depends on the machine.
//! 2. A record is complete or absent. A study names damaged records and never reads them as data;
//!    [`Control::with_verification`] computes their values again.
//! 3. Any number of processes, started at any time, can run a study at the same time, and each ramp is run by
//!    one of them. The processes must see each other's file locks, as on a local file system, or on NFS from
//!    version 4 on.
//! 4. A study writes only into an empty folder or its own folder, and changes or removes only its own files.
//! 5. All records of a study come from the same code, unless you accept a change. `provenance.json` keeps the
//!    [`RESULTS`](granular_edmd::RESULTS) of the crate and the [revision](Experiment::revision) of the
//!    experiment, and other code gets an error that names the differences ([`StudyError::Code`]), until
//!    [`Study::accept_changes`] allows this code to continue.
//! 6. If a run cannot progress, the [`Outcome`] of its value says so, and the study continues.
//!
//! ```
//! use granular_edmd_study::vibrated_box::{Base, VibratedBox};
//! use granular_edmd_study::{Control, Course, Plan, Protocol, Ramp, Study};
//!
//! let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
//! let experiment = VibratedBox::new(30, 10.0, base).with_height(30.0).with_contact_duration(1e-4);
//! let experiment = experiment.with_gravity(0.0156);
//! let ramp = Ramp::new("friction", [0.01, 0.02], Course::Up)?;
//! let plan = Plan::new(experiment, Protocol::new(10, 4, 5)?, 1)?.with_ramp(ramp)?;
//!
//! # let folder = std::env::temp_dir().join(format!("granular-edmd-study-{}", std::process::id()));
//! let study = Study::open_or_create(&folder, &plan)?;
//! let summary = study.run(&Control::default())?;
//! assert!(summary.is_complete());
//! for record in study.records() {
//!     let record = record?;
//!     println!("{} {}", record.experiment().friction, record.mean(|sample| sample.height));
//!     assert_eq!(record.samples().len(), 4);
//! }
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod analysis;
#[cfg(feature = "cli")]
pub mod cli;
mod errors;
mod execution;
mod experiment;
mod folder;
pub mod guide;
mod parameters;
mod plan;
mod records;
mod sliced;
mod store;
mod study;
mod tables;
pub mod vibrated_box;

pub use errors::{Difference, ExperimentError, PlanError, StudyError};
pub use execution::{Control, Progress, Summary};
pub use experiment::record::{Leg, Outcome, Record};
pub use experiment::{Column, Table};
pub use experiment::{Experiment, Run};
pub use parameters::Scalar;
pub use plan::Plan;
pub use plan::protocol::Protocol;
pub use plan::ramp::{Bracket, Course, Ramp, Width};
pub use plan::values::Axis;
pub use records::{Point, RampStatus};
pub use sliced::{SavedDriving, Start};
pub use study::Study;
