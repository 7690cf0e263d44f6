#![doc = include_str!("../docs/guide/index.md")]
// Chapters are modules without items. So their code is compiled and run with the tests, and the search of the
// documentation finds them.

#[doc = include_str!("../docs/guide/choose_a_rule.md")]
pub mod choose_a_rule {}

#[doc = include_str!("../docs/guide/shake_it.md")]
pub mod shake_it {}

#[doc = include_str!("../docs/guide/fill_it.md")]
pub mod fill_it {}

#[doc = include_str!("../docs/guide/watch_it.md")]
pub mod watch_it {}

#[cfg(feature = "serde")]
#[doc = include_str!("../docs/guide/sweep_it.md")]
pub mod sweep_it {}

#[doc = include_str!("../docs/guide/believe_it.md")]
pub mod believe_it {}

#[doc = include_str!("../docs/guide/draw_it.md")]
pub mod draw_it {}

#[doc = include_str!("../docs/guide/write_files.md")]
pub mod write_files {}

#[doc = include_str!("../docs/guide/bring_your_own.md")]
pub mod bring_your_own {}

#[doc = include_str!("../docs/guide/when_it_stalls.md")]
pub mod when_it_stalls {}

#[doc = include_str!("../docs/guide/when_it_is_slow.md")]
pub mod when_it_is_slow {}

#[doc = include_str!("../docs/guide/glossary.md")]
pub mod glossary {}
