//! Frames that were found in a file.

use super::ReadError;
use super::lines::Text;
use super::settings::Settings;
use super::table::Table;

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
                    let note = "the last line has no line break: its last number may be cut short";
                    table.notes.push(note.to_owned());
                }
                _ => {}
            }
            Ok(table)
        };
        Self { step, read: Box::new(read) }
    }
}

/// The function that reads a frame.
pub(super) type Reading<'a> = Box<dyn FnOnce(&Settings) -> Result<Table, ReadError> + 'a>;

/// The frames of a file, one after another.
pub(super) type Frames<'a> = Box<dyn Iterator<Item = Result<Found<'a>, ReadError>> + 'a>;
