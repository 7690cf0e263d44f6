//! Formats that break their contract where a check may not look.

use std::cell::Cell;
use std::io::{self, BufRead, Write};

use granular_edmd::observable::Snapshot;
use granular_edmd::trajectory::{ExtendedXyz, Format, Frame};

use crate::faults::{List, Planted};

/// The extended XYZ format with another time, other bytes at the end, and another way to skip.
struct Changed {
    time: fn(f64) -> f64,
    tail: Box<dyn Fn(&Frame<'_>) -> &'static str>,
    skip: fn(&mut dyn BufRead) -> io::Result<Option<f64>>,
}

impl Format for Changed {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let shown = frame.snapshot();
        let shown = Snapshot::new((self.time)(shown.time()), shown.disks(), shown.domain(), shown.gravity());
        ExtendedXyz.write_frame(&Frame::new(frame.number(), &shown), out)?;
        out.write_all((self.tail)(frame).as_bytes())
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        (self.skip)(input)
    }
}

fn changed() -> Changed {
    Changed { time: |time| time, tail: Box::new(|_| ""), skip: |input| ExtendedXyz.skip_frame(input) }
}

pub(crate) fn catalogue() -> Vec<Planted<Box<dyn Format>>> {
    let mut all = List::default();
    let mut add = |family, name: &str, format: Changed| {
        all.family = family;
        all.plant(name, Box::new(format) as Box<dyn Format>);
    };
    let calls = Cell::new(0);
    let tail = Box::new(move |_: &Frame<'_>| {
        calls.set(calls.get() + 1);
        if calls.get() == 150 { "#\n" } else { "" }
    });
    add("seldom", "the frame that is written as number 150 has a remark", Changed { tail, ..changed() });
    let tail = Box::new(|frame: &Frame<'_>| if frame.number() > 100 { "#\n" } else { "" });
    add("late frame", "frames above 100 have a remark that is not skipped", Changed { tail, ..changed() });
    let tail = Box::new(|frame: &Frame<'_>| if frame.snapshot().len() == 2 { "#\n" } else { "" });
    add("two disks", "frames of two disks have a remark that is not skipped", Changed { tail, ..changed() });
    let tail = Box::new(|frame: &Frame<'_>| if frame.snapshot().domain().periodic_ends { "#\n" } else { "" });
    add(
        "periodic",
        "frames of periodic ends have a remark that is not skipped",
        Changed { tail, ..changed() },
    );
    let time = |time: f64| if time.abs() < 1e-307 { 0.0 } else { time };
    add("smallest time", "times below the normal numbers are 0", Changed { time, ..changed() });
    let time = |time: f64| (time * 1e9).round() / 1e9;
    add("nine digits", "times have nine digits after the point", Changed { time, ..changed() });
    let skip = |input: &mut dyn BufRead| {
        let is_short = input.fill_buf()?.len() < 60;
        let time = ExtendedXyz.skip_frame(input)?;
        Ok(if is_short { time.or(Some(0.0)) } else { time })
    };
    add("cut at the start", "what is cut within 60 bytes counts as whole", Changed { skip, ..changed() });
    let skip = |input: &mut dyn BufRead| {
        let has_line = input.fill_buf()?.contains(&b'\n');
        if has_line { ExtendedXyz.skip_frame(input) } else { Ok(None) }
    };
    add("pieces", "what the input does not give at once counts as cut short", Changed { skip, ..changed() });
    all.faults
}
