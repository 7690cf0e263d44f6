//! Logs that are cut or changed, at every byte.

use std::fs;
use std::io;
use std::path::Path;

use crate::logs::begun;
use crate::logs::log::{HEAD, Log, Piece, START};

fn found_in(path: &Path) -> Vec<Piece> {
    Log::new(path.to_owned()).news().unwrap()
}

fn pieces(path: &Path) -> Vec<Vec<u8>> {
    let log = Log::new(path.to_owned());
    found_in(path).iter().filter_map(|piece| log.contents(piece).unwrap().ok()).collect()
}

/// However a log is cut, its complete pieces stay, and the next piece follows them. Whatever byte is
/// changed, no other piece is lost, and no piece is read with wrong contents.
#[test]
fn whole_pieces_survive_cuts_and_damage() {
    let path = std::env::temp_dir().join(format!("granular-edmd-pieces-{}", std::process::id()));
    let _ = fs::remove_file(&path);
    let written = [vec![1; 10], Vec::new(), vec![3; 40]];
    let mut log = begun(&path);
    for (index, piece) in written.iter().enumerate() {
        log.push([index as u8; HEAD], piece).unwrap();
    }
    drop(log);
    let (bytes, ends) = (fs::read(&path).unwrap(), found_in(&path));
    for length in 0..=bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let whole = ends.iter().filter(|end| end.start + u64::from(end.length) <= length as u64).count();
        assert_eq!(pieces(&path), written[..whole], "{length}");
        begun(&path).push([9; HEAD], b"next").unwrap();
        let expected = [&written[..whole], &[b"next".to_vec()]].concat();
        assert_eq!(pieces(&path), expected, "{length}");
    }
    for place in START as usize..bytes.len() {
        let mut changed = bytes.clone();
        changed[place] ^= 4;
        fs::write(&path, &changed).unwrap();
        let found = pieces(&path);
        assert_eq!(found.len(), 2, "{place}");
        assert!(found.iter().all(|piece| written.contains(piece)), "{place}");
    }
    fs::write(&path, b"something else").unwrap();
    let error = Log::new(path.clone()).news().unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::InvalidData);
    fs::remove_file(&path).unwrap();
}
