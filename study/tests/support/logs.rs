//! The records in the logs of a study: they are looked at, taken out and forged.
#![allow(dead_code, reason = "each target needs some of it")]

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use granular_edmd::file::Locked;

use log::{Log, Piece};

// The store's own reader and writer, which are not public.
#[path = "../../src/store/log.rs"]
pub(crate) mod log;

/// A piece of a log, with ramp and value.
struct Found {
    log: PathBuf,
    piece: Piece,
    place: [u32; 2],
}

impl Found {
    fn contents(&self) -> Vec<u8> {
        Log::new(self.log.clone()).contents(&self.piece).unwrap().unwrap_or_default()
    }
}

/// Returns the logs of all blocks.
fn files(folder: &Path) -> Vec<PathBuf> {
    let all = fs::read_dir(folder.join("blocks")).into_iter().flatten();
    let mut all: Vec<PathBuf> = all.map(|file| file.unwrap().path()).collect();
    all.sort();
    all
}

fn pieces(log: &Path) -> Vec<Found> {
    let number = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    let found = |piece: Piece| {
        let place = [number(&piece.head[..4]), number(&piece.head[4..8])];
        Found { log: log.to_owned(), piece, place }
    };
    Log::new(log.to_owned()).news().unwrap().into_iter().map(found).collect()
}

/// Returns the last piece of each record.
fn latest(folder: &Path) -> BTreeMap<[u32; 2], Found> {
    let found = files(folder).into_iter().flat_map(|log| pieces(&log));
    let mut all: BTreeMap<[u32; 2], Found> = found.map(|found| (found.place, found)).collect();
    // A value that counts as not done.
    all.retain(|_, found| found.piece.head[8] & 1 == 0);
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
    let mut log = begun(log);
    for (head, place, contents) in all {
        if let Some(contents) = change(place, contents) {
            log.push(head, &contents).unwrap();
        }
    }
}

/// Begins to append to a log.
pub(crate) fn begun(path: &Path) -> Log {
    let file = fs::File::options().read(true).write(true).create(true).truncate(false).open(path).unwrap();
    let mut log = Log::new(path.to_owned());
    log.begin(Locked::take(file).unwrap()).unwrap();
    log
}

/// Takes a record out.
pub(crate) fn forget(folder: &Path, ramp: u32, value: u32) {
    for log in files(folder) {
        rewrite(&log, |place, contents| (place != [ramp, value]).then_some(contents));
    }
}

/// Gives a record other contents, under a right checksum.
pub(crate) fn replace(folder: &Path, ramp: u32, value: u32, new: &[u8]) {
    for log in files(folder) {
        rewrite(&log, |place, contents| Some(if place == [ramp, value] { new.to_vec() } else { contents }));
    }
}

/// Returns the seconds that each value took, for each time that it was finished; NaN if it was taken over.
pub(crate) fn finished(folder: &Path) -> BTreeMap<[u32; 2], Vec<f32>> {
    let mut all: BTreeMap<_, Vec<f32>> = BTreeMap::new();
    for Found { place, piece, .. } in files(folder).iter().flat_map(|log| pieces(log)) {
        if piece.head[8] & 1 == 0 {
            all.entry(place).or_default().push(f32::from_le_bytes(piece.head[12..].try_into().unwrap()));
        }
    }
    all
}

/// Returns whether a file of a study has the same bytes however its work was divided: not those of logs.
fn is_the_same_always(name: &Path) -> bool {
    !name.starts_with("blocks")
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
