//! Chapters of the [guide](granular_edmd::guide) that need files.
// Chapters are modules without items, so that the tests compile and run their code, and the search of the
// documentation finds them.

#[doc(alias("trajectory", "restart", "checkpoint", "OVITO", "ParaView", "LAMMPS"))]
#[doc = include_str!("../docs/guide/write_files.md")]
pub mod write_files {}

#[doc(alias("convert", "ASE", "pandas", "polars", "MDAnalysis", "freud", "HOOMD", "import", "export"))]
#[doc = include_str!("../docs/guide/recipes.md")]
pub mod recipes {}
