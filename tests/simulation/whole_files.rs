//! Files of checkpoints are whole, whoever else writes and reads, and nothing is left beside them.

use std::error::Error as _;
use std::{fs, io, thread};

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::simulation::Checkpoint;
use granular_edmd::{Simulation, initial};

use crate::scratch::Scratch;

fn checkpoint(disks: usize) -> Checkpoint {
    let container = Container::closed(12.0, 10.0).unwrap();
    let disks = initial::lattice(&container, disks, 0.5).unwrap();
    Simulation::builder(Elastic, container).disks(disks).build().unwrap().checkpoint()
}

fn names(scratch: &Scratch) -> Vec<std::ffi::OsString> {
    fs::read_dir(scratch.path("")).unwrap().map(|entry| entry.unwrap().file_name()).collect()
}

#[test]
fn a_failure_leaves_nothing_and_takes_nothing() {
    let scratch = Scratch::new("failure");
    let folder = scratch.path("folder");
    fs::create_dir(&folder).unwrap();
    assert!(checkpoint(1).write(&folder).is_err(), "a file cannot take the place of a folder");
    for path in ["", "..", "/"] {
        let error = checkpoint(1).write(path).unwrap_err();
        let source = error.source().and_then(|source| source.downcast_ref::<io::Error>());
        assert_eq!(source.map(io::Error::kind), Some(io::ErrorKind::InvalidInput), "{path:?}");
    }
    assert_eq!(names(&scratch), ["folder"]);
}

#[cfg(unix)]
#[test]
fn a_name_of_the_greatest_length_is_written() {
    let scratch = Scratch::new("length");
    let path = scratch.path(&"n".repeat(255));
    checkpoint(1).write(&path).unwrap();
    assert_eq!(Checkpoint::read(path).unwrap(), checkpoint(1));
}

/// A file made of parts of two writes would have a wrong checksum.
#[test]
fn two_writers_of_one_file_do_not_disturb_each_other_nor_a_reader() {
    const WRITES: u32 = 400;
    let scratch = Scratch::new("writers");
    let path = &scratch.path("file");
    let states = [1, 40].map(checkpoint);
    states[0].write(path).unwrap();
    thread::scope(|scope| {
        let write = |state: &Checkpoint| (0..WRITES).try_for_each(|_| state.write(path));
        let writers = states.each_ref().map(|state| scope.spawn(move || write(state)));
        let mut reads = 0;
        while writers.iter().any(|writer| !writer.is_finished()) {
            assert!(states.contains(&Checkpoint::read(path).unwrap()), "read {reads}");
            reads += 1;
        }
        for writer in writers {
            writer.join().unwrap().unwrap();
        }
    });
    assert_eq!(names(&scratch), ["file"], "nothing is left");
}
