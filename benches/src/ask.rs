//! Settings from the environment and the command line. Most are environment variables and not flags, so that
//! criterion's flags can be passed to all benches.

use std::env;
use std::path::PathBuf;

use crate::Outcome;

/// Returns whether everything should run only once and briefly, as under `cargo bench -- --test`.
pub fn is_test() -> bool {
    env::args().any(|argument| argument == "--test")
}

/// Returns the whole number above zero that this variable holds, or the default.
pub fn number(variable: &str, default: u32) -> Outcome<u32> {
    let Ok(text) = env::var(variable) else { return Ok(default) };
    let number = text.trim().parse().ok().filter(|&number| number > 0);
    number.ok_or_else(|| format!("{variable} must be a whole number from 1 on, not “{text}”").into())
}

/// Returns whether this variable is set to anything other than an empty text or 0.
pub fn flag(variable: &str) -> bool {
    env::var(variable).is_ok_and(|text| !matches!(text.as_str(), "" | "0"))
}

/// Returns the path that this variable holds.
pub fn path(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|text| !text.is_empty()).map(PathBuf::from)
}
