//! Recorders: the contents of a file after a run, a kill, a full drive, and a run that goes on.

use std::fs;
use std::io::{self, BufRead, Write};
use std::path::Path;

use granular_edmd::Kind;
use granular_edmd::boundary::Domain;
use granular_edmd::observable::{OfKind, SampleTimes, Snapshot, laws};
use granular_edmd::simulation::RunError;
use granular_edmd_files::{
    ByEnding, ExtendedXyz, Frame, FrameFormat, Gsd, LammpsDump, Reader, RecordError, Recorder, Vtk,
};

use crate::scratch::Scratch;
use crate::states::{for_each_snapshot, mixture};
use support::cases::few;
use support::report::report;

fn times() -> SampleTimes {
    SampleTimes::every(0.5).unwrap()
}

fn snapshot(time: f64) -> Snapshot<'static> {
    Snapshot::new(time, &[], Domain::new(0.0, 10.0, 0.0, 10.0), 1.0)
}

/// Names of files for one recorder, as far as this build can write them.
fn names() -> Vec<&'static str> {
    if cfg!(feature = "gzip") {
        vec!["a.xyz", "a.dump", "a.xyz.gz", "a.dump.gz"]
    } else {
        vec!["a.xyz", "a.dump"]
    }
}

fn create(path: &Path) -> Recorder {
    Recorder::create(path, ByEnding, times()).unwrap()
}

fn append(path: &Path) -> Result<Recorder, RecordError> {
    Recorder::append(path, ByEnding, times())
}

/// Returns the bytes of a file that a run of six frames has recorded, and the length of the file after each
/// frame.
fn recorded(path: &Path) -> (Vec<u8>, Vec<usize>) {
    let (mut run, mut recorder) = (mixture(), create(path));
    let lengths = (1..=6).map(|frame| {
        run.run_until(0.5 * f64::from(frame), &mut recorder).unwrap();
        fs::metadata(path).unwrap().len() as usize
    });
    let lengths = lengths.collect();
    (fs::read(path).unwrap(), lengths)
}

#[test]
fn a_recorder_keeps_the_contract_of_observers() {
    let scratch = Scratch::new("contract");
    laws::check(&mut create(&scratch.path("laws.xyz"))).unwrap();
    laws::check(&mut create(&scratch.path("laws.pvd"))).unwrap();
    laws::check(&mut create(&scratch.path("laws.gsd"))).unwrap();
}

#[test]
fn recording_does_not_change_a_run() {
    let scratch = Scratch::new("bits");
    let (mut plain, mut watched) = (mixture(), mixture());
    plain.run_until(3.0, &mut ()).unwrap();
    watched.run_until(3.0, &mut create(&scratch.path("a.xyz"))).unwrap();
    assert_eq!(plain.disks(), watched.disks());
}

#[test]
fn nothing_is_overwritten() {
    let scratch = Scratch::new("overwrite");
    let path = scratch.path("notes.xyz");
    fs::write(&path, "my notes").unwrap();
    let error = Recorder::create(&path, ExtendedXyz, times()).unwrap_err();
    assert!(matches!(error, RecordError::Exists { .. }));
    assert!(report(&error).ends_with("notes.xyz already exists and is not overwritten; choose another name"));
    // A recorder that goes on in the file does not overwrite it, either.
    for text in ["my notes", "my notes\n", "12", "", "3\nmy notes\n"] {
        fs::write(&path, text).unwrap();
        assert!(Recorder::append(&path, ExtendedXyz, times()).is_err(), "{text:?}");
        assert!(Recorder::append(&path, LammpsDump, times()).is_err(), "{text:?}");
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
    assert!(matches!(append(&scratch.path("none.xyz")), Err(RecordError::Io { action: "open", .. })));
}

/// Notes after the frames are not a frame, and the recorder leaves them.
#[test]
fn what_others_have_appended_is_left() {
    let scratch = Scratch::new("foreign");
    for name in names() {
        let path = scratch.path(name);
        let (mut bytes, _) = recorded(&path);
        bytes.extend(b"my notes\n");
        fs::write(&path, &bytes).unwrap();
        let error = append(&path).unwrap_err();
        assert!(report(&error).contains("cannot continue"), "{}", report(&error));
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

#[test]
fn one_recorder_at_a_time_writes_to_a_file() {
    let scratch = Scratch::new("lock");
    let path = scratch.path("a.xyz");
    let mut recorder = create(&path);
    recorder.record(&snapshot(1.0)).unwrap();
    assert!(matches!(append(&path), Err(RecordError::Locked { .. })));
    drop(recorder);
    append(&path).unwrap();
}

/// A process may be killed with any part of the last frame written, and the run goes on from a checkpoint
/// that is older. The file ends like that of a run that was left alone.
#[test]
fn a_killed_run_goes_on_in_the_same_file() {
    let scratch = Scratch::new("kill");
    for name in names() {
        let path = scratch.path(name);
        let (whole, lengths) = recorded(&path);
        let cuts = (lengths[2]..=whole.len()).step_by(whole.len() / 40).chain(lengths[2..].iter().copied());
        for cut in cuts {
            fs::write(&path, &whole[..cut]).unwrap();
            let (mut run, mut recorder) = (mixture(), append(&path).unwrap());
            assert!(recorder.times().len() >= 2, "{name} {cut}");
            // Frames 3 and on, as from a checkpoint at the time of the second one.
            run.run_until(1.0, &mut ()).unwrap();
            run.run_until(3.0, &mut recorder).unwrap();
            assert_eq!(recorder.times(), [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
            drop(recorder);
            assert!(fs::read(&path).unwrap() == whole, "{name} cut at {cut} of {}", whole.len());
        }
    }
}

/// The format of the value, and the one that the ending asks for, in a new file and in one that is there.
#[test]
fn a_format_is_chosen_by_value_or_by_ending() {
    let scratch = Scratch::new("endings");
    let written = |path: &Path, begun: Result<Recorder, RecordError>| {
        mixture().run_until(1.0, &mut begun.unwrap()).unwrap();
        fs::read(path).unwrap()
    };
    let named = |name: &str| {
        let path = scratch.path(name);
        written(&path, Recorder::create(&path, ByEnding, times()))
    };
    let path = scratch.path("value");
    let by_value = |format: fn(&Path) -> Result<Recorder, RecordError>| {
        let _ = fs::remove_file(&path);
        written(&path, format(&path))
    };
    let xyz = by_value(|path| Recorder::create(path, ExtendedXyz, times()));
    let dump = by_value(|path| Recorder::create(path, LammpsDump, times()));
    let gsd = by_value(|path| Recorder::create(path, Gsd, times()));
    assert!([named("a.xyz"), named("b.extxyz"), named("c.XYZ")].iter().all(|bytes| *bytes == xyz));
    assert!([named("a.dump"), named("b.lammpstrj")].iter().all(|bytes| *bytes == dump));
    assert!(named("a.gsd") == gsd && named("run.pvd").starts_with(b"<?xml"));
    for name in ["run.png", "other", "run.vtp", ".xyz.png"] {
        let error = report(&Recorder::create(scratch.path(name), ByEnding, times()).unwrap_err());
        assert!(error.contains("no format is known for this ending"), "{error}");
        assert!(!scratch.path(name).exists());
    }
    // A file that is empty is begun, whatever its format; one that is not is gone on with.
    for name in ["d.xyz", "d.gsd", "d.pvd"] {
        fs::write(scratch.path(name), "").unwrap();
        for end in [0.7, 2.0] {
            let mut recorder = Recorder::create_or_append(scratch.path(name), ByEnding, times()).unwrap();
            mixture().run_until(end, &mut recorder).unwrap();
        }
        assert_eq!(append(&scratch.path(name)).unwrap().times(), [0.5, 1.0, 1.5, 2.0]);
    }
    assert!(Recorder::create(scratch.path("value.pvd"), Gsd, times()).is_ok());
    assert!(Recorder::create(scratch.path("value.gsd"), Vtk, times()).is_err());
}

/// Pieces of 0.9 end a rounding before a sampling time, which a clock that begins anew would take for
/// one at the start of the run.
#[test]
fn a_kill_between_two_pieces_loses_no_frame() {
    let scratch = Scratch::new("pieces");
    for name in ["a.xyz", "a.pvd", "a.gsd"] {
        let (times, mut run) = (SampleTimes::every(0.25).unwrap(), mixture());
        let path = scratch.path(name);
        let mut recorder = Recorder::create(&path, ByEnding, times).unwrap();
        for _ in 0..30 {
            run.run_until(run.time() + 0.9, &mut recorder).unwrap();
        }
        // A run that ends a rounding before a sample ends at the sample.
        assert_eq!(run.time(), 27.0);
        drop(recorder);
        let mut recorder = Recorder::append(&path, ByEnding, times).unwrap();
        run.run_until(30.0, &mut recorder).unwrap();
        let expected: Vec<f64> = (1..=120).map(|beat| 0.25 * f64::from(beat)).collect();
        assert_eq!(recorder.times(), expected);
    }
}

/// A run that goes on from a checkpoint after the last frame would leave frames out.
#[test]
fn a_gap_needs_consent() {
    let scratch = Scratch::new("gap");
    let path = scratch.path("a.xyz");
    let mut run = mixture();
    run.run_until(1.0, &mut create(&path)).unwrap();
    run.run_until(2.2, &mut ()).unwrap();
    let mut recorder = append(&path).unwrap();
    for _ in 0..2 {
        let error = run.run_until(3.0, &mut recorder).unwrap_err();
        let told = "a.xyz ends at time 1.0, so a run from time 2.2 on would leave out the frame at time 1.5; continue from an earlier \
                    checkpoint, or accept the gap with SampleTimes::starting_at";
        assert!(report(&error).ends_with(told), "{}", report(&error));
    }
    drop(recorder);
    let mut recorder = Recorder::append(&path, ExtendedXyz, times().starting_at(2.5).unwrap()).unwrap();
    run.run_until(3.0, &mut recorder).unwrap();
    assert_eq!(recorder.times(), [0.5, 1.0, 2.5, 3.0]);
}

/// No frame of a time that cannot be read back gets into a file.
#[test]
fn a_frame_needs_a_time() {
    let scratch = Scratch::new("no-time");
    let path = scratch.path("a.xyz");
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut recorder = Recorder::create(&path, ExtendedXyz, times()).unwrap();
        recorder.record(&snapshot(time)).unwrap_err();
        assert!(recorder.times().is_empty());
        drop(recorder);
        fs::remove_file(&path).unwrap();
    }
}

#[test]
fn a_frame_of_another_run_is_refused() {
    let scratch = Scratch::new("another");
    for name in names().into_iter().chain(["a.pvd", "a.gsd"]) {
        let path = scratch.path(name);
        let mut recorder = create(&path);
        let mut run = mixture();
        run.run_until(3.0, &mut recorder).unwrap();
        drop(recorder);
        let before = fs::read(&path).unwrap();
        let mut recorder = append(&path).unwrap();
        let mut other = mixture();
        other.set_gravity(0.31).unwrap();
        let error = other.run_until(3.0, &mut recorder).unwrap_err();
        assert!(
            report(&error).ends_with("it ends at time 3.0, and has another frame at time 0.5"),
            "{error}"
        );
        let error = recorder.record(&snapshot(0.7)).unwrap_err();
        assert!(report(&error).ends_with("it ends at time 3.0, and has no frame at time 0.7"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), before);
    }
}

#[test]
fn disks_of_one_kind_are_recorded() {
    let scratch = Scratch::new("kind");
    let path = scratch.path("a.xyz");
    let mut small = OfKind::new(Kind::new(7), create(&path));
    let mut run = mixture();
    run.run_until(1.0, &mut small).unwrap();
    let state = Reader::new().read(&path).unwrap();
    assert_eq!(state.disks().len(), 14);
    assert!(state.disks().iter().all(|disk| disk.kind() == Kind::new(7)));
}

/// A format that fails from some time on, until it is repaired.
struct Failing(f64);

impl FrameFormat for Failing {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{:?}", frame.snapshot().time())?;
        if frame.snapshot().time() < self.0 { Ok(()) } else { Err(io::ErrorKind::StorageFull.into()) }
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        let mut line = String::new();
        input.read_line(&mut line)?;
        Ok(line.trim_end().parse().ok().filter(|_| line.ends_with('\n')))
    }
}

#[test]
fn a_failure_ends_the_run_when_it_happens() {
    let scratch = Scratch::new("failure");
    let path = scratch.path("own");
    let mut run = mixture();
    let mut recorder = Recorder::create(&path, Failing(1.2), times()).unwrap();
    let error = run.run_until(3.0, &mut recorder).unwrap_err();
    assert!(matches!(error, RunError::Observer { time: 1.5, .. }), "{error}");
    assert!(report(&error).contains("cannot make a frame of"), "{}", report(&error));
    assert_eq!(fs::read_to_string(&path).unwrap(), "0.5\n1.0\n");
    drop(recorder);
    // The run goes on in the file, and takes the frame that was missed.
    let mut recorder =
        Recorder::append(&path, Failing(f64::INFINITY), times().starting_at(1.5).unwrap()).unwrap();
    run.run_until(2.0, &mut recorder).unwrap();
    assert_eq!(recorder.times(), [0.5, 1.0, 1.5, 2.0]);
}

/// The same recorder goes on after a failure, too.
#[test]
fn a_missed_frame_is_taken_once_there_is_room() {
    let scratch = Scratch::new("room");
    let path = scratch.path("run.pvd");
    let mut recorder = Recorder::create(&path, Vtk, times()).unwrap();
    let mut run = mixture();
    run.run_until(1.0, &mut recorder).unwrap();
    // A folder takes the place of the next file.
    let place = scratch.path("run/disks_000002.vtp");
    fs::create_dir(&place).unwrap();
    run.run_until(3.0, &mut recorder).unwrap_err();
    assert_eq!(run.time(), 1.5);
    fs::remove_dir(&place).unwrap();
    run.run_until(3.0, &mut recorder).unwrap();
    assert_eq!(recorder.times(), [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
}

/// The child of the next test: it records until there is no more room.
#[test]
#[ignore = "needs a limit of the sizes of files, as a part of another test"]
fn records_until_there_is_no_room() {
    let Ok(path) = std::env::var("FULL_RECORDING") else { return };
    let (mut run, mut recorder) = (mixture(), create(Path::new(&path)));
    let error = run.run_until(1000.0, &mut recorder).unwrap_err();
    assert!(report(&error).contains("cannot write to"), "{}", report(&error));
    let frames = recorder.times().len();
    assert!(frames > 5 && run.time() == 0.5 * (frames + 1) as f64);
}

/// A file that may not grow beyond 64 kB keeps its whole frames. Once there is room, the next one follows.
#[cfg(unix)]
#[test]
fn a_full_disk_keeps_the_whole_frames() {
    let scratch = Scratch::new("full");
    for name in names() {
        let path = scratch.path(name);
        let limited = "trap '' XFSZ; ulimit -f 128; exec \"$0\" --exact recording::records_until_there_is_no_room --ignored";
        let mut child = std::process::Command::new("sh");
        child.args(["-c", limited]).arg(std::env::current_exe().unwrap());
        let output = child.env("FULL_RECORDING", &path).output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stdout));
        let mut recorder = append(&path).unwrap();
        let frames = recorder.times().len();
        assert_eq!(Reader::new().read(&path).unwrap().time(), Some(0.5 * frames as f64));
        recorder.record(&snapshot(0.5 * (frames + 1) as f64)).unwrap();
        drop(recorder);
        assert_eq!(append(&path).unwrap().times().len(), frames + 1);
    }
}

#[cfg(not(feature = "gzip"))]
#[test]
fn compression_needs_its_feature() {
    let scratch = Scratch::new("feature");
    let path = scratch.path("a.xyz.gz");
    assert!(matches!(
        Recorder::create(&path, ExtendedXyz, times()),
        Err(RecordError::Io { action: "use", .. })
    ));
    assert!(!path.exists());
    fs::write(&path, [0x1f, 0x8b]).unwrap();
    assert!(
        report(&Reader::new().read(&path).unwrap_err())
            .ends_with("it is compressed, which needs the feature `gzip` of granular-edmd-files")
    );
}

#[cfg(feature = "gzip")]
#[test]
fn a_compressed_file_is_one_member_of_the_same_text() {
    use std::io::Read;
    let scratch = Scratch::new("gzip");
    let (plain, packed) = (recorded(&scratch.path("a.xyz")), recorded(&scratch.path("a.xyz.gz")));
    let mut text = Vec::new();
    flate2::read::GzDecoder::new(packed.0.as_slice()).read_to_end(&mut text).unwrap();
    assert!(text == plain.0);
    assert!(2 * packed.0.len() < plain.0.len());
    let state = Reader::new().read(scratch.path("a.xyz.gz")).unwrap();
    assert_eq!(state.time(), Some(3.0));
}

/// A recorder that went on would write a checksum of the damaged frames, which no reader could tell from a
/// sound one.
#[cfg(feature = "gzip")]
#[test]
fn a_damaged_compressed_file_is_not_gone_on_with() {
    let scratch = Scratch::new("damaged");
    let text = |packed: &[u8]| {
        let mut text = Vec::new();
        std::io::Read::read_to_end(&mut flate2::read::GzDecoder::new(packed), &mut text).map(|_| text).ok()
    };
    for name in ["a.xyz.gz", "a.dump.gz"] {
        let path = scratch.path(name);
        let (sound, _) = recorded(&path);
        for place in (10..sound.len() - 10).step_by(131) {
            let mut bytes = sound.clone();
            bytes[place] ^= 4;
            fs::write(&path, &bytes).unwrap();
            // Another way to write the same text is no damage: a repetition may count from elsewhere.
            assert!(append(&path).is_err() || text(&bytes) == text(&sound), "{name}, byte {place}");
            assert!(fs::read(&path).unwrap() == bytes, "{name}, byte {place}");
        }
        fs::write(&path, sound).unwrap();
        assert_eq!(append(&path).unwrap().times().len(), 6);
        fs::remove_file(&path).unwrap();
    }
}

/// A file that lost its ending, or part of it, gets it back before the next frame.
#[cfg(feature = "gzip")]
#[test]
fn a_compressed_file_gets_its_ending_back() {
    use std::io::Read;
    let scratch = Scratch::new("ending");
    for name in ["a.xyz.gz", "a.dump.gz"] {
        let path = scratch.path(name);
        let (sound, _) = recorded(&path);
        for lost in 1..=11 {
            fs::write(&path, &sound[..sound.len() - lost]).unwrap();
            let mut text = Vec::new();
            let read = |text: &mut Vec<u8>| {
                flate2::read::GzDecoder::new(fs::File::open(&path).unwrap()).read_to_end(text)
            };
            assert!(read(&mut text).is_err(), "{name} {lost}");
            let frames = append(&path).unwrap().times().len();
            assert_eq!(frames, if lost == 11 { 5 } else { 6 }, "{name} {lost}");
            assert!(read(&mut Vec::new()).is_ok(), "{name} {lost}");
            assert_eq!(fs::read(&path).unwrap() == sound, lost < 11, "{name} {lost}");
        }
    }
}

/// An input that gives its bytes one by one, as a file may anywhere give only a part.
struct Trickle<'a>(&'a [u8]);

impl io::Read for Trickle<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let few = into.len().min(1);
        self.0.read(&mut into[..few])
    }
}

/// A frame that is written twice has the same bytes. Exactly these are skipped, however they come, and a
/// frame that is cut short at any byte is not one.
#[test]
fn formats_keep_their_contract() {
    for format in [&ExtendedXyz as &dyn FrameFormat, &LammpsDump] {
        for_each_snapshot(|snapshot| {
            let frame = Frame::new(7, snapshot);
            let [bytes, again] = [(); 2].map(|()| {
                let mut bytes = Vec::new();
                format.write_frame(&frame, &mut bytes).unwrap();
                bytes
            });
            assert!(bytes == again);
            let mut input = io::BufReader::with_capacity(1, Trickle(&bytes));
            let time = format.skip_frame(&mut input).unwrap().unwrap();
            assert!(time.to_bits() == snapshot.time().to_bits() && input.get_ref().0.is_empty());
            for cut in few(1..bytes.len(), 3) {
                assert!(matches!(format.skip_frame(&mut &bytes[..cut]), Ok(None)), "{cut}");
            }
        });
    }
}

/// The child of the next test: it records without end.
#[test]
#[ignore = "runs until it is killed, as a part of another test"]
fn records_until_it_is_killed() {
    let Ok(path) = std::env::var("KILLED_RECORDING") else { return };
    mixture().run_until(1e6, &mut create(Path::new(&path))).unwrap();
}

#[test]
fn a_process_that_is_killed_leaves_whole_frames() {
    let scratch = Scratch::new("killed");
    for name in names() {
        let path = scratch.path(name);
        let mut child = std::process::Command::new(std::env::current_exe().unwrap());
        child.args(["--exact", "recording::records_until_it_is_killed", "--ignored"]);
        let child = child.env("KILLED_RECORDING", &path).stdout(std::process::Stdio::null());
        let mut child = child.stderr(std::process::Stdio::null()).spawn().unwrap();
        while fs::metadata(&path).map_or(0, |file| file.len()) < 100_000 {
            assert!(child.try_wait().unwrap().is_none(), "{name}: the child has ended by itself");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let mut recorder = append(&path).unwrap();
        let frames = recorder.times().len();
        assert!(frames > 5, "{name} {frames}");
        // From a checkpoint at the time of the third frame.
        let mut run = mixture();
        run.run_until(1.5, &mut ()).unwrap();
        run.run_until(0.5 * (frames + 2) as f64, &mut recorder).unwrap();
        assert_eq!(recorder.times().len(), frames + 2, "{name}");
    }
}

/// Damage within a file is refused, or ends at a whole frame before it; the recorder never panics, and never
/// takes more frames for whole than there were.
#[test]
fn a_damaged_file_is_left_or_cut_at_a_whole_frame() {
    let scratch = Scratch::new("damage");
    for name in names() {
        let path = scratch.path(name);
        let (whole, _) = recorded(&path);
        for place in (0..whole.len()).step_by(whole.len() / 97) {
            let mut bytes = whole.clone();
            bytes[place] ^= 0x15;
            fs::write(&path, &bytes).unwrap();
            // Only a line more or less in the last frame looks like a frame that was not finished.
            let least = if name.ends_with("gz") { 6 } else { 5 };
            match append(&path) {
                Ok(recorder) => assert!((least..=6).contains(&recorder.times().len()), "{name} {place}"),
                Err(error) => assert!(!report(&error).is_empty()),
            }
            assert!(fs::read(&path).unwrap() == bytes, "{name} {place}: a look changes nothing");
        }
    }
}

#[test]
fn a_file_is_begun_or_gone_on_with() {
    let scratch = Scratch::new("begun");
    let (whole, path) = (scratch.path("whole.xyz"), scratch.path("path.xyz"));
    let (bytes, _) = recorded(&whole);
    fs::write(&path, "").unwrap();
    for end in [0.2, 1.7, 3.0] {
        // The state of then is made anew.
        let mut run = mixture();
        let mut recorder = Recorder::create_or_append(&path, ExtendedXyz, times()).unwrap();
        run.run_until(end, &mut recorder).unwrap();
    }
    assert!(fs::read(&path).unwrap() == bytes);
    fs::write(&path, "notes\n").unwrap();
    assert!(Recorder::create_or_append(&path, ExtendedXyz, times()).is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), "notes\n");
}
