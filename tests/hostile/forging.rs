//! Files whose checksum is right and whose contents are wrong, and a watch over those that read them.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, Once};

use crate::limits::Limits;
use crate::specimens::{CONTENTS_AT, sealed};

/// Returns the bytes that are written over the contents at each place: floats, and lengths and indices in
/// their encoding.
pub(crate) fn patterns() -> Vec<Vec<u8>> {
    let floats = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        -1.0,
        -0.0,
        0.5,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        1e-30,
        1e60,
    ];
    let floats = floats.iter().map(|float| float.to_le_bytes().to_vec());
    let varints = [u64::MAX, 1 << 32, u64::from(u32::MAX), 1000].map(varint);
    let bytes = [0, 1, 2, 3, 4, 5, 0x7f, 0x80, 0xff].map(|byte| vec![byte]);
    floats.chain(varints).chain(bytes).collect()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// The file with each pattern at each `stride`-th place of its contents, under a right checksum.
pub(crate) fn forged(file: &[u8], stride: usize) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let contents = &file[CONTENTS_AT..];
    let places = (0..contents.len()).flat_map(|place| patterns().into_iter().map(move |with| (place, with)));
    let files = places.flat_map(|(place, with)| {
        // The pattern replaces as many bytes, or a single one, as a longer length would.
        [place + with.len(), place + 1].map(|end| {
            let rest = &contents[end.min(contents.len())..];
            (place, sealed(file, &[&contents[..place], &with, rest].concat()))
        })
    });
    files.step_by(stride)
}

static CASE: AtomicUsize = AtomicUsize::new(0);

/// The file that is tried.
static TRIED: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Ends the process with a message if one case takes too long, and leaves the file.
fn watch() {
    static STARTED: Once = Once::new();
    let watch = || {
        loop {
            let case = CASE.load(Ordering::Relaxed);
            std::thread::sleep(std::time::Duration::from_secs(20));
            if CASE.load(Ordering::Relaxed) == case {
                let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hanging-file");
                let _ = fs::write(&path, &*TRIED.lock().unwrap());
                eprintln!("case {case} hangs: {}", path.display());
                std::process::abort();
            }
        }
    };
    STARTED.call_once(|| drop(std::thread::spawn(watch)));
}

/// Does all cases, and names each panic once.
pub(crate) fn none_panics(cases: impl Iterator<Item = (usize, Vec<u8>)>, mut check: impl FnMut(&[u8])) {
    watch();
    let mut panics = BTreeMap::new();
    for (place, bytes) in cases {
        CASE.fetch_add(1, Ordering::Relaxed);
        TRIED.lock().unwrap().clone_from(&bytes);
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| check(&bytes))) {
            let said = panic.downcast_ref::<String>().cloned();
            let said = said.or_else(|| panic.downcast_ref::<&str>().map(|&said| said.to_owned()));
            panics.entry(said.unwrap_or_default()).or_insert(place);
        }
    }
    assert!(panics.is_empty(), "panics, with the first place of each: {panics:#?}");
}

/// Variable with the stride: one of this many forged files is tried.
pub(crate) const STRIDE: &str = "GRANULAR_EDMD_HOSTILE_STRIDE";

pub(crate) fn stride() -> usize {
    std::env::var(STRIDE).map_or(1, |stride| stride.parse().unwrap())
}

pub(crate) const LITTLE: Limits = Limits { memory_kib: 1 << 20, seconds: 600, file_kib: None };
