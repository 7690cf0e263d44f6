//! Formats of trajectories that break their contract.

use std::cell::Cell;
use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::io::{self, BufRead, Read, Write};

use granular_edmd::observable::Snapshot;
use granular_edmd::trajectory::{ExtendedXyz, Format, Frame};

use crate::faults::{List, Planted};

/// The extended XYZ format with other bytes or other times.
struct Altered {
    /// Changes the bytes of a frame.
    write: Box<dyn Fn(&Frame<'_>, &mut Vec<u8>)>,
    /// Returns the time that is written for a frame.
    time: Box<dyn Fn(f64) -> f64>,
    skip: Box<dyn Fn(&mut dyn BufRead) -> io::Result<Option<f64>>>,
}

impl Default for Altered {
    fn default() -> Self {
        Self {
            write: Box::new(|_, _| ()),
            time: Box::new(|time| time),
            skip: Box::new(|input| ExtendedXyz.skip_frame(input)),
        }
    }
}

impl Format for Altered {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let time = (self.time)(snapshot.time());
        let snapshot = Snapshot::new(time, snapshot.disks(), snapshot.domain(), snapshot.gravity());
        let mut bytes = Vec::new();
        ExtendedXyz.write_frame(&Frame::new(frame.number(), &snapshot), &mut bytes)?;
        (self.write)(frame, &mut bytes);
        out.write_all(&bytes)
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        (self.skip)(input)
    }
}

/// The catalogue while it grows.
type Formats = List<Box<dyn Format>>;

impl Formats {
    fn add(&mut self, name: impl Into<String>, format: Altered) {
        self.plant(name, Box::new(format));
    }

    fn add_write(&mut self, name: &str, write: impl Fn(&Frame<'_>, &mut Vec<u8>) + 'static) {
        self.add(name, Altered { write: Box::new(write), ..Altered::default() });
    }

    fn add_time(&mut self, name: &str, time: impl Fn(f64) -> f64 + 'static) {
        self.add(name, Altered { time: Box::new(time), ..Altered::default() });
    }

    fn add_skip<F>(&mut self, name: &str, skip: F)
    where
        F: Fn(&mut dyn BufRead) -> io::Result<Option<f64>> + 'static,
    {
        self.add(name, Altered { skip: Box::new(skip), ..Altered::default() });
    }
}

/// Returns the format on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Box<dyn Format>>> {
    let mut formats = Formats::default();
    formats.add("extended XYZ", Altered::default());
    formats.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Box<dyn Format>>> {
    List::grown(&[histories, lengths, times, torn])
}

/// "`write_frame` depends on the frame alone: written twice, the same frame gives the same bytes."
fn histories(formats: &mut Formats) {
    let frames = Cell::new(0);
    formats.family = "history";
    formats.add_write("frames are counted by the format, in place of blanks at the end", move |_, bytes| {
        frames.set(frames.get() + 1);
        pad(bytes, frames.get());
    });
    let frames = Cell::new(0);
    formats.add_write("the hundredth frame that is written ends in a blank", move |_, bytes| {
        frames.set(frames.get() + 1);
        pad(bytes, usize::from(frames.get() == 100));
    });
    let is_first = Cell::new(true);
    formats.add_write("the first frame that is written has a longer header", move |_, bytes| {
        pad(bytes, usize::from(is_first.replace(false)));
    });
    let longest = Cell::new(0);
    formats.add_write("a frame is as wide as the widest one before it", move |_, bytes| {
        longest.set(longest.get().max(bytes.len()));
        pad(bytes, longest.get() - bytes.len());
    });
    let last = Cell::new(0.0);
    formats.add_time("the time is that since the last frame", move |time| time - last.replace(time));
    formats.add_write("the bytes have random blanks", |_, bytes| {
        pad(bytes, (RandomState::new().hash_one(0) % 7) as usize);
    });
    let last = Cell::new(usize::MAX);
    formats.add_write(
        "a frame that has the number of the last one is written without bytes",
        move |frame, bytes| {
            if last.replace(frame.number()) == frame.number() {
                bytes.clear();
            }
        },
    );
}

/// Puts blanks before the end of the second line, where readers do not mind them.
fn pad(bytes: &mut Vec<u8>, count: usize) {
    let breaks = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(place, _)| place);
    let place = breaks.take(2).last().unwrap_or(0);
    bytes.splice(place..place, std::iter::repeat_n(b' ', count));
}

/// "`skip_frame` skips exactly the bytes that `write_frame` wrote."
fn lengths(formats: &mut Formats) {
    formats.family = "too short";
    formats.add_write("a line at the end is not skipped", |_, bytes| bytes.extend(b"# end\n"));
    formats.add_write("a line break at the end is not skipped", |_, bytes| bytes.push(b'\n'));
    formats.add_write("a line at the end of a frame without disks is not skipped", |frame, bytes| {
        if frame.snapshot().is_empty() {
            bytes.extend(b"# no disks\n");
        }
    });
    formats.add_write("a line at the end of frame 2 is not skipped", |frame, bytes| {
        if frame.number() == 2 {
            bytes.extend(b"# 2\n");
        }
    });
    formats.add_write("a line for an open top is not skipped", |frame, bytes| {
        if frame.snapshot().domain().top == f64::INFINITY {
            bytes.extend(b"# open\n");
        }
    });
    formats.family = "too long";
    formats.add_skip("a line of the next frame is skipped", |input| {
        let time = ExtendedXyz.skip_frame(input)?;
        input.read_until(b'\n', &mut Vec::new())?;
        Ok(time)
    });
    formats.add_skip("a byte of the next frame is skipped", |input| {
        let time = ExtendedXyz.skip_frame(input)?;
        let _ = input.read(&mut [0])?;
        Ok(time)
    });
    formats.add_skip("all frames are skipped, and the last time is returned", |input| {
        let mut last = None;
        while let Some(time) = ExtendedXyz.skip_frame(input)? {
            last = Some(time);
        }
        Ok(last)
    });
    formats.add_skip("a buffer of its own reads ahead", |input| {
        ExtendedXyz.skip_frame(&mut io::BufReader::new(input))
    });
}

/// "The time of the frame to the bit."
fn times(formats: &mut Formats) {
    let rounded: [(&str, fn(f64) -> f64); 7] = [
        ("in single precision", |time| f64::from(time as f32)),
        ("with six digits after the point", |time| (time * 1e6).round() / 1e6),
        ("with fifteen digits", |time| format!("{time:.14e}").parse().unwrap_or(time)),
        ("without its sign", f64::abs),
        ("with a zero that is positive", |time| time + 0.0),
        ("as 0 if it is below 1e-300", |time| if time.abs() < 1e-300 { 0.0 } else { time }),
        ("as 1e15 if it is above", |time| time.min(1e15)),
    ];
    formats.family = "time";
    for (name, round) in rounded {
        formats.add_time(&format!("the time is written {name}"), round);
    }
    formats.add_skip("the time that is read is later by the last bit", |input| {
        Ok(ExtendedXyz.skip_frame(input)?.map(f64::next_up))
    });
}

/// "`None` if the frame is cut short."
fn torn(formats: &mut Formats) {
    formats.family = "torn";
    formats.add_skip("a frame that is cut short counts as one of time 0", |input| {
        Ok(Some(ExtendedXyz.skip_frame(input)?.unwrap_or(0.0)))
    });
    formats.add_skip("a frame without its last line break counts as whole", |input| {
        ExtendedXyz.skip_frame(&mut input.chain(&b"\n"[..]))
    });
    formats.add_skip("a frame that is cut short is an error", |input| {
        ExtendedXyz.skip_frame(input)?.map(Some).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    });
}
