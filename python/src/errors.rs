//! Rust's errors as Python's exceptions, with the same sentences.

use std::cell::RefCell;
use std::error::Error;

use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(granular_edmd, ParameterError, PyValueError, "A number or a part cannot be used.");
create_exception!(granular_edmd, RunError, PyRuntimeError, "A run ended with an error. The state is kept.");
create_exception!(granular_edmd, CheckpointError, PyValueError, "A checkpoint cannot be used.");
create_exception!(granular_edmd, FileError, PyOSError, "A file cannot be read or written.");

/// Returns the exception for a number or a part that cannot be used.
pub(crate) fn invalid(error: impl Error) -> PyErr {
    ParameterError::new_err(sentence(&error))
}

/// Returns the exception for a checkpoint that cannot be used.
pub(crate) fn unusable(error: impl Error) -> PyErr {
    CheckpointError::new_err(sentence(&error))
}

/// Returns the exception for a file that cannot be read or written.
pub(crate) fn unreadable(error: impl Error) -> PyErr {
    FileError::new_err(sentence(&error))
}

/// Returns the message of an error, followed by those of its causes that add something.
pub(crate) fn sentence(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let next = cause.to_string();
        if !text.contains(&next) {
            text = format!("{text}: {next}");
        }
        source = cause.source();
    }
    // Python has the initial states without their module.
    text.replace("initial::", "")
}

thread_local! {
    /// The exception of a Python function that the run on this thread called.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Calls Python from a run. An exception is kept for [`or_raised`], since most traits of the library have no
/// way to return it.
///
/// After an exception nothing is called: the engine asks a rule a second time before it ends a run, and would
/// go on with the other answer.
pub(crate) fn call<T>(code: impl FnOnce(Python<'_>) -> PyResult<T>) -> Option<T> {
    if RAISED.with_borrow(Option::is_some) {
        return None;
    }
    let keep = |error| {
        RAISED.with_borrow_mut(|raised| {
            raised.get_or_insert(error);
        });
    };
    Python::attach(code).map_err(keep).ok()
}

/// Returns the exception that a Python function raised since the last call, or otherwise the result.
pub(crate) fn or_raised<T>(result: PyResult<T>) -> PyResult<T> {
    RAISED.take().map_or(result, Err)
}
