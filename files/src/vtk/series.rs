//! A series of files, one for each frame, and the file that lists their times.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{write_box, write_disks};

use crate::format::no_frame;
use crate::recording::{Growing, Layout, Recording, Start};
use crate::{Frame, RecordError};

/// Beginning and ending of the file of times. The ending follows each frame, so that the file is always
/// whole.
const HEAD: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
const TAIL: &str = "</Collection>\n</VTKFile>\n";

/// Frames in separate files, in a folder beside the file of times.
struct Series {
    folder: PathBuf,
    /// Name of the folder, as written in the file of times.
    name: String,
}

/// Begins a series, or continues it after its last complete frame.
pub(crate) fn open(path: &Path, start: Start) -> Result<Recording, RecordError> {
    let (folder, name) = place(path)?;
    let (mut file, is_new) = Growing::open(path, start)?;
    let mut all = Vec::new();
    if is_new {
        fs::create_dir(&folder).map_err(|error| {
            if start == Start::New {
                let _ = fs::remove_file(path);
            }
            match error.kind() {
                io::ErrorKind::AlreadyExists => RecordError::Exists { path: folder.clone() },
                _ => RecordError::io("create", &folder)(error),
            }
        })?;
        file.push(HEAD.as_bytes(), TAIL.as_bytes())?;
    } else {
        let text = io::read_to_string(&file.file).map_err(RecordError::io("read", path))?;
        let (times, length) = times(&text, &name);
        if !times.is_empty() && !is_torn(&text[length..], &name, times.len()) {
            return Err(RecordError::io("continue", path)(no_frame("an ending", &text[length..])));
        }
        file.resume(length as u64, TAIL.into());
        all = times;
    }
    Recording::new(file, is_new, all, Series { folder, name })
}

impl Series {
    /// Writes one of a frame's files. A killed run may have left that file, complete or not.
    fn write(&self, part: &str, number: usize, bytes: &[u8]) -> Result<(), RecordError> {
        let path = self.folder.join(file_name(part, number));
        let file = match fs::read(&path) {
            Ok(there) if there == bytes => return Ok(()),
            Ok(there) if bytes.starts_with(&there) => File::create(&path),
            Ok(_) => return Err(RecordError::Exists { path }),
            Err(_) => File::create_new(&path),
        };
        let mut file = file.map_err(RecordError::io("create", &path))?;
        file.write_all(bytes).map_err(|error| {
            // An incomplete file is harmless, but it takes room on a full drive.
            let _ = fs::remove_file(&path);
            RecordError::io("write to", &path)(error)
        })
    }
}

impl Layout for Series {
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()> {
        let snapshot = frame.snapshot();
        write_disks(bytes, snapshot.disks(), Some(&snapshot.domain()), Some(snapshot.time()))
    }

    fn push(&mut self, file: &mut Growing, frame: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        let (mut edges, number, snapshot) = (Vec::new(), frame.number(), frame.snapshot());
        write_box(&mut edges, snapshot).map_err(RecordError::io("make a frame of", &file.path))?;
        self.write("disks", number, bytes)?;
        self.write("box", number, &edges)?;
        file.push(entry(&self.name, number, snapshot.time()).as_bytes(), TAIL.as_bytes())
    }

    fn has(&self, _: &Growing, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        let path = self.folder.join(file_name("disks", number));
        Ok(fs::read(&path).map_err(RecordError::io("read", &path))? == bytes)
    }
}

/// Returns the folder of the frames, and its name in the file of times.
fn place(path: &Path) -> Result<(PathBuf, String), RecordError> {
    let name = path.file_stem().and_then(|name| name.to_str());
    if let Some(name) = name.filter(|_| path.extension().is_some_and(|ending| ending == "pvd")) {
        return Ok((path.with_extension(""), escaped(name)));
    }
    Err(RecordError::unusable(path, "the name must be valid Unicode and end in .pvd"))
}

fn file_name(part: &str, number: usize) -> String {
    format!("{part}_{number:06}.vtp")
}

/// Returns the lines of a frame in the file of times.
fn entry(folder: &str, number: usize, time: f64) -> String {
    let line = |index: usize, part: &str| {
        let file = file_name(part, number);
        format!(
            "<DataSet timestep=\"{time:?}\" part=\"{index}\" name=\"{part}\" file=\"{folder}/{file}\"/>\n"
        )
    };
    line(0, "disks") + &line(1, "box")
}

/// Returns the times of the complete frames that a file of times lists, and the length of the text up to the
/// end of the last complete entry.
fn times(text: &str, folder: &str) -> (Vec<f64>, usize) {
    let (mut times, mut length) = (Vec::new(), HEAD.len());
    let Some(mut rest) = text.strip_prefix(HEAD) else { return (times, 0) };
    loop {
        let quoted = rest.strip_prefix("<DataSet timestep=\"").and_then(|rest| rest.split_once('"'));
        let Some(time) = quoted.and_then(|(time, _)| time.parse().ok()) else { break };
        let entry = entry(folder, times.len(), time);
        let Some(after) = rest.strip_prefix(entry.as_str()) else { break };
        times.push(time);
        length += entry.len();
        rest = after;
    }
    (times, length)
}

/// Returns true if the rest of a file of times is no longer than its ending, or is an unfinished frame.
fn is_torn(rest: &str, folder: &str, number: usize) -> bool {
    let time = rest.strip_prefix("<DataSet timestep=\"").and_then(|rest| rest.split_once('"'));
    let entry = time.and_then(|(time, _)| time.parse().ok()).map(|time| entry(folder, number, time) + TAIL);
    rest.len() <= TAIL.len() || entry.is_some_and(|entry| entry.starts_with(rest))
}

/// Returns a text with the characters that have a meaning in XML escaped.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
