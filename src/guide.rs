// On code hosts, the links of the pages lead to files. The first definition of a link wins, so the
// definitions here lead to modules instead.

//! [`choose_a_rule`]: self::choose_a_rule
//! [`shake_it`]: self::shake_it
//! [`gases`]: self::gases
//! [`fill_it`]: self::fill_it
//! [`watch_it`]: self::watch_it
//! [`believe_it`]: self::believe_it
//! [`draw_it`]: self::draw_it
//! [`from_python`]: self::from_python
//! [`bring_your_own`]: self::bring_your_own
//! [`when_it_stalls`]: self::when_it_stalls
//! [`when_it_is_slow`]: self::when_it_is_slow
//! [`exercise_erratum`]: self::exercise_erratum
//! [`glossary`]: self::glossary
//! [`physics`]: self::physics
//! [`physics_kinetic`]: self::physics_kinetic
//! [`rest`]: self::rest
//! [`validation`]: self::validation
//! [`performance`]: self::performance
//! [`stability`]: self::stability
#![doc = "[`write_files`]: https://docs.rs/granular-edmd-files/latest/granular_edmd_files/guide/write_files/index.html"]
#![doc = "[`recipes`]: https://docs.rs/granular-edmd-files/latest/granular_edmd_files/guide/recipes/index.html"]
#![doc = "[`sweep_it`]: https://docs.rs/granular-edmd-study/latest/granular_edmd_study/guide/sweep_it/index.html"]
#![doc = "[`exercise_rolls`]: https://docs.rs/granular-edmd-study/latest/granular_edmd_study/guide/exercise_rolls/index.html"]
//! [`replay`]: crate::replay
#![doc(alias("event-driven", "hard-sphere", "tutorial", "timestep"))]
#![cfg_attr(feature = "serde", doc = "[`Checkpoint`]: crate::simulation::Checkpoint")]
#![cfg_attr(not(feature = "serde"), doc = "[`Checkpoint`]: crate#features")]
#![doc = include_str!("../docs/guide/index.md")]
// Chapters are modules without items, so that the tests compile and run their code, and the search of the
// documentation finds them.

#[doc(alias("coefficient of restitution", "friction", "contact model", "hard-sphere"))]
#[doc = include_str!("../docs/guide/choose_a_rule.md")]
pub mod choose_a_rule {}

#[doc(alias("Γ", "Gamma", "vibration", "driving", "periodic"))]
#[doc = include_str!("../docs/guide/shake_it.md")]
pub mod shake_it {}

#[doc(alias("chute", "inclined plane", "thermostat", "DSMC", "homogeneous cooling state"))]
#[doc = include_str!("../docs/guide/gases.md")]
pub mod gases {}

#[doc(alias("polydisperse", "bidisperse", "initial condition", "packing fraction"))]
#[doc = include_str!("../docs/guide/fill_it.md")]
pub mod fill_it {}

#[doc(alias("pressure", "measurement", "viscosity"))]
#[doc = include_str!("../docs/guide/watch_it.md")]
pub mod watch_it {}

#[doc(alias("error bar", "convergence", "equilibration"))]
#[doc = include_str!("../docs/guide/believe_it.md")]
pub mod believe_it {}

#[doc(alias("plot", "visualization", "Python"))]
#[doc = include_str!("../docs/guide/draw_it.md")]
pub mod draw_it {}

#[doc(alias("extension", "plugin", "custom"))]
#[doc = include_str!("../docs/guide/bring_your_own.md")]
pub mod bring_your_own {}

#[doc(alias("Python", "numpy", "pandas"))]
#[doc = include_str!("../docs/guide/from_python.md")]
pub mod from_python {}

#[doc(alias("inelastic collapse", "Zeno", "endless bouncing"))]
#[doc = include_str!("../docs/guide/when_it_stalls.md")]
pub mod when_it_stalls {}

#[doc(alias("speed", "parallel"))]
#[doc = include_str!("../docs/guide/when_it_is_slow.md")]
pub mod when_it_is_slow {}

#[doc(alias("lecture", "exercise", "course"))]
#[doc = "[images/exercise_erratum.png]: data:image/png,#docs/images/exercise_erratum.png"]
#[doc = include_str!("../docs/guide/exercise_erratum.md")]
pub mod exercise_erratum {}

#[doc(alias("symbols", "notation"))]
#[doc = include_str!("../docs/guide/glossary.md")]
pub mod glossary {}

// Pages of the repository. A definition for a picture leads nowhere, so that its description is shown;
// `site/build` shows the file after the `#`.

#[doc(alias("equations", "notation", "thermal wall"))]
#[doc = "[physics-kinetic.md]: crate::guide::physics_kinetic"]
#[doc = "[rest.md]: crate::guide::rest"]
#[doc = include_str!("../docs/physics.md")]
pub mod physics {}

#[doc(alias("dissipation", "energy loss"))]
#[doc = include_str!("../docs/physics-kinetic.md")]
pub mod physics_kinetic {}

#[doc(alias("heap", "silo", "jamming"))]
#[doc = "[images/rest.png]: data:image/png,#docs/images/rest.png"]
#[doc = include_str!("../docs/rest.md")]
pub mod rest {}

#[doc(alias("literature", "tests"))]
#[doc = include_str!("../docs/validation.md")]
pub mod validation {}

#[doc(alias("benchmark", "profile", "LAMMPS"))]
#[doc = "[images/scaling.png]: data:image/png,#docs/images/scaling.png"]
#[doc = include_str!("../docs/performance.md")]
pub mod performance {}

#[doc(alias("semver", "compatibility"))]
#[doc = include_str!("../docs/stability.md")]
pub mod stability {}

/// The programs of the README, so that they are compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
