//! The records in the logs of a study: they are looked at, taken out and forged.
#![allow(dead_code, reason = "each target needs some of it")]

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::ops::Range;
use std::path::{Path, PathBuf};

use granular_edmd::file::Seal;

use log::{Log, Piece, read_piece};

// The store's own reader and writer, which are not public.
#[path = "../../src/store/log.rs"]
pub(crate) mod log;

pub(crate) const SEAL: Seal = Seal::new(*b"GRANSTUD", 6);

/// A piece of a log, with ramp, value and edition.
struct Found {
    log: PathBuf,
    piece: Piece,
    place: [u32; 2],
    edition: u16,
}

impl Found {
    fn contents(&self) -> Vec<u8> {
        read_piece(&mut File::open(&self.log).unwrap(), &self.piece).unwrap().unwrap_or_default()
    }
}

/// Returns the files of an ending in the folder `logs`.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let all = fs::read_dir(folder.join("logs")).into_iter().flatten();
    let mut all: Vec<PathBuf> = all.map(|file| file.unwrap().path()).collect();
    all.retain(|path| path.extension().is_some_and(|found| found == ending));
    all.sort();
    all
}

fn pieces(log: &Path) -> Vec<Found> {
    let number = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    let found = |piece: Piece| {
        let place = [number(&piece.head[..4]), number(&piece.head[4..8])];
        Found { log: log.to_owned(), piece, place, edition: number(&piece.head[8..12]) as u16 }
    };
    self::log::pieces(log, SEAL, 0).unwrap().found.into_iter().map(found).collect()
}

/// Returns the last edition of each record.
fn latest(folder: &Path) -> BTreeMap<[u32; 2], Found> {
    let mut all = BTreeMap::new();
    for found in files(folder, "records").iter().flat_map(|log| pieces(log)) {
        let is_newer = all.get(&found.place).is_none_or(|known: &Found| known.edition < found.edition);
        if is_newer {
            all.insert(found.place, found);
        }
    }
    // A value that counts as not done.
    all.retain(|_, found| found.piece.head[10] & 1 == 0);
    all
}

/// Returns the contents of all records, as if each were a file.
pub(crate) fn records(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = latest(folder).into_iter();
    all.map(|([ramp, value], found)| (format!("records/{ramp}/{value}").into(), found.contents())).collect()
}

/// Returns the contents of a record.
pub(crate) fn record(folder: &Path, ramp: u32, value: u32) -> Vec<u8> {
    latest(folder)[&[ramp, value]].contents()
}

/// Returns the log of a record, and the place of its whole piece.
pub(crate) fn place(folder: &Path, ramp: u32, value: u32) -> (PathBuf, Range<usize>) {
    let found = latest(folder).remove(&[ramp, value]).unwrap();
    let before = pieces(&found.log).into_iter().map(|other| end(&other.piece));
    let start = before.filter(|end| *end <= found.piece.start as usize).max().unwrap_or(12);
    (found.log, start..end(&found.piece))
}

fn end(piece: &Piece) -> usize {
    piece.start as usize + piece.length as usize
}

/// Writes a log anew, with the contents that `change` makes of each piece; without those of which it makes
/// none.
fn rewrite(log: &Path, mut change: impl FnMut([u32; 2], Vec<u8>) -> Option<Vec<u8>>) {
    let all: Vec<_> =
        pieces(log).into_iter().map(|found| (found.piece.head, found.place, found.contents())).collect();
    fs::write(log, "").unwrap();
    let mut log = Log::open(log, SEAL).unwrap();
    for (head, place, contents) in all {
        if let Some(contents) = change(place, contents) {
            log.push(head, &contents).unwrap();
        }
    }
}

/// Takes a record out.
pub(crate) fn forget(folder: &Path, ramp: u32, value: u32) {
    for log in files(folder, "records") {
        rewrite(&log, |place, contents| (place != [ramp, value]).then_some(contents));
    }
}

/// Gives a record other contents, under a right checksum.
pub(crate) fn replace(folder: &Path, ramp: u32, value: u32, new: &[u8]) {
    for log in files(folder, "records") {
        rewrite(&log, |place, contents| Some(if place == [ramp, value] { new.to_vec() } else { contents }));
    }
}

/// Returns the lines for people of all processes.
pub(crate) fn lines(folder: &Path) -> String {
    files(folder, "jsonl").iter().map(|path| fs::read_to_string(path).unwrap()).collect()
}

/// Returns whether a file of a study has the same bytes however its work was divided: not those of logs and
/// locks.
fn is_the_same_always(name: &Path) -> bool {
    !name.starts_with("logs") && !name.starts_with("locks")
}

/// Returns all files of a study whose bytes do not depend on how its work was divided or how often it was
/// stopped, and each record as if it were a file.
pub(crate) fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = records(folder);
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().to_owned();
            if path.is_dir() {
                folders.push(path);
            } else if is_the_same_always(&name) {
                files.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    files
}
