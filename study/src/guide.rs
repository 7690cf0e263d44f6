//! Chapters of the [guide](granular_edmd::guide) that need studies.
// Chapters are modules without items, so that the tests compile and run their code, and the search of the
// documentation finds them.

#[doc(alias("parameter scan", "hysteresis", "ensemble"))]
#[doc = include_str!("../docs/guide/sweep_it.md")]
pub mod sweep_it {}

#[doc(alias("lecture", "exercise", "course"))]
#[doc = "[images/fig3.png]: data:image/png,#docs/reproduction/fig3_order_parameters.png"]
#[doc = include_str!("../docs/guide/exercise_rolls.md")]
pub mod exercise_rolls {}
