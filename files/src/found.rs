//! Frames that were found in a file.

use super::ReadError;
use super::lines::Text;
use super::table::Table;

/// Settings of a reader for data that a file lacks, or gives in few digits.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Settings {
    pub(super) tolerance: Option<f64>,
    pub(super) shrinks: bool,
    pub(super) density: Option<f64>,
    pub(super) radius: Option<f64>,
    /// The factor of all lengths in the file.
    pub(super) scale: f64,
}

/// A frame that was found in a file, and is read only on request.
pub(super) struct Found<'a> {
    /// The step with which the file labels the frame.
    pub(super) step: Option<u64>,
    pub(super) read: Reading<'a>,
}

impl<'a> Found<'a> {
    /// Creates a frame from its text and the function that reads it.
    pub(super) fn in_text(
        text: Text,
        step: Option<u64>,
        read: impl FnOnce(&Text) -> Result<Table, ReadError> + 'a,
    ) -> Self {
        let read = move |_: &Settings| {
            let mut table = read(&text)?;
            match (text.is_torn(), table.is_own, table.lines.last()) {
                (true, true, Some(&line)) => {
                    return Err(ReadError::End { line, what: "a line break".to_owned() });
                }
                (true, ..) => {
                    table.notes.push(TORN.to_owned());
                }
                _ => {}
            }
            Ok(table)
        };
        Self { step, read: Box::new(read) }
    }
}

/// The note about a text without a last line break.
pub(super) const TORN: &str = "the last line has no line break: its last number may be cut short";

/// The note about a radius that was given for a file with radii.
pub(super) const RADIUS_IGNORED: &str = "the radius that was given is ignored, since the file has radii";

/// The function that reads a frame.
pub(super) type Reading<'a> = Box<dyn FnOnce(&Settings) -> Result<Table, ReadError> + 'a>;

/// The frames of a file, one after another.
pub(super) type Frames<'a> = Box<dyn Iterator<Item = Result<Found<'a>, ReadError>> + 'a>;
