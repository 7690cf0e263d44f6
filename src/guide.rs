#![doc = include_str!("../docs/guide/index.md")]
#![doc(alias("event-driven", "hard-sphere", "tutorial"))]
// Chapters are modules without items, so that the tests compile and run their code, and the search of the
// documentation finds them.

#[doc(alias("restitution", "friction", "contact model", "hard-sphere"))]
#[doc = include_str!("../docs/guide/choose_a_rule.md")]
pub mod choose_a_rule {}

#[doc(alias("Γ", "Gamma", "vibration", "driving", "periodic"))]
#[doc = include_str!("../docs/guide/shake_it.md")]
pub mod shake_it {}

#[doc(alias("polydisperse", "bidisperse", "initial condition"))]
#[doc = include_str!("../docs/guide/fill_it.md")]
pub mod fill_it {}

#[doc(alias("pressure", "measurement"))]
#[doc = include_str!("../docs/guide/watch_it.md")]
pub mod watch_it {}

#[cfg(feature = "serde")]
#[doc(alias("parameter scan", "hysteresis", "ensemble"))]
#[doc = include_str!("../docs/guide/sweep_it.md")]
pub mod sweep_it {}

#[doc(alias("error bar", "convergence", "equilibration"))]
#[doc = include_str!("../docs/guide/believe_it.md")]
pub mod believe_it {}

#[doc(alias("plot", "visualization"))]
#[doc = include_str!("../docs/guide/draw_it.md")]
pub mod draw_it {}

#[doc(alias("trajectory", "restart", "checkpoint", "OVITO", "ParaView", "LAMMPS"))]
#[doc = include_str!("../docs/guide/write_files.md")]
pub mod write_files {}

#[doc(alias("extension", "plugin", "custom"))]
#[doc = include_str!("../docs/guide/bring_your_own.md")]
pub mod bring_your_own {}

#[doc(alias("inelastic collapse", "Zeno", "endless bouncing"))]
#[doc = include_str!("../docs/guide/when_it_stalls.md")]
pub mod when_it_stalls {}

#[doc(alias("performance", "speed"))]
#[doc = include_str!("../docs/guide/when_it_is_slow.md")]
pub mod when_it_is_slow {}

#[doc(alias("symbols", "notation"))]
#[doc = include_str!("../docs/guide/glossary.md")]
pub mod glossary {}
