//! An error with its sources, as a program would report it.

use std::error::Error;

/// Returns the messages of an error and of its sources.
pub fn messages(error: &(dyn Error + 'static)) -> Vec<String> {
    std::iter::successors(Some(error), |&error| error.source()).map(ToString::to_string).collect()
}

/// Returns all messages in one line.
pub fn report(error: &(dyn Error + 'static)) -> String {
    messages(error).join(": ")
}
