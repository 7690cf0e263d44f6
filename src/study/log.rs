//! The log of a study, to which all its processes add lines.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Adds a line to a file, under the lock of that file.
///
/// Without the lock, two hosts that append over a network write to the same place. If a kill or a full drive
/// has cut the last line short, that line is removed first, so that every line is whole.
pub(super) fn append(path: &Path, line: &str) -> io::Result<()> {
    let mut file = File::options().read(true).write(true).create(true).truncate(false).open(path)?;
    file.lock()?;
    let written = to_last_line_end(&mut file).and_then(|()| file.write_all(format!("{line}\n").as_bytes()));
    // A process that was forked meanwhile may have the file open, too. Closing the file here would then not
    // release the lock.
    let _ = file.unlock();
    written
}

/// Goes to the end of the last whole line, and removes what follows it.
fn to_last_line_end(file: &mut File) -> io::Result<()> {
    let end = file.seek(SeekFrom::End(0))?;
    let mut last = [b'\n'];
    if end > 0 {
        file.seek(SeekFrom::Start(end - 1))?;
        file.read_exact(&mut last)?;
    }
    if last != [b'\n'] {
        let mut bytes = Vec::new();
        file.rewind()?;
        file.read_to_end(&mut bytes)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        file.set_len(whole as u64)?;
        file.seek(SeekFrom::End(0))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::thread;

    use super::*;

    fn scratch(name: &str) -> std::path::PathBuf {
        let path = std::env::temp_dir().join(format!("granular-edmd-log-{name}-{}", std::process::id()));
        let _ = fs::remove_file(&path);
        path
    }

    #[test]
    fn a_line_that_was_cut_short_goes() {
        for (before, after) in [("", ""), ("half", ""), ("one\n", "one\n"), ("one\nhal", "one\n")] {
            let path = scratch("cut");
            fs::write(&path, before).unwrap();
            append(&path, "next").unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), format!("{after}next\n"));
            fs::remove_file(&path).unwrap();
        }
    }

    #[test]
    fn no_line_of_many_writers_is_lost_or_torn() {
        let path = scratch("many");
        let line = |writer: usize| char::from(b'a' + writer as u8).to_string().repeat(3000 + 1000 * writer);
        thread::scope(|scope| {
            for writer in 0..4 {
                let (path, line) = (&path, line(writer));
                scope.spawn(move || (0..100).for_each(|_| append(path, &line).unwrap()));
            }
        });
        let text = fs::read_to_string(&path).unwrap();
        let count = |writer| text.lines().filter(|found| *found == line(writer)).count();
        assert_eq!((0..4).map(count).collect::<Vec<_>>(), [100; 4]);
        assert_eq!(text.lines().count(), 400);
        fs::remove_file(&path).unwrap();
    }
}
