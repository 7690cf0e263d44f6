//! Every fault of a file, with its line and its value.

use std::fmt::Write as _;
use std::io::Read as _;

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;
use granular_edmd_files::{ExtendedXyz, Frame, FrameFormat, LammpsDump, ReadError, Reader, State};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::states::{domain, random_disks};
use support::report::report;

const UNKNOWN: &str = "line 1: the file must be extended XYZ, a dump or a data file of LAMMPS, GSD, or a table whose \
                       first line names columns such as x, y and radius, but is \"weight,height\"";

const OVERLAP: &str = "line 4: the disk overlaps the disk of line 2 by 0.25, a share of 0.25 of their distance at \
                       contact; it is the deepest of 1 such overlaps; set a tolerance or shrink the radii to accept them";

#[track_caller]
fn assert_told<T: std::fmt::Debug>(read: Result<T, ReadError>, expected: &str) {
    assert_eq!(report(&read.unwrap_err()), expected);
}

#[test]
fn faults_of_tables() {
    let cases = [
        ("", "the file ends after line 0, where a frame should follow"),
        ("x,y\n", "line 1: the column `radius`, or one radius for all (with_radius, --radius), is missing"),
        ("x,y,radius\n1,2,0.5\n\n1,zwei,0.5\n", "line 4: y must be a number, but is \"zwei\""),
        ("x,y,radius\n1,2\n", "line 2: the number of values must be 3, one for each column, but is \"2\""),
        (
            "x,y,radius\n1,2,0.5,9\n",
            "line 2: the number of values must be 3, one for each column, but is \"4\"",
        ),
        ("weight,height\n1,2\n", UNKNOWN),
        (
            "x,y,radius,diameter\n1,2,0.5,1\n3,2,0.25,0.25\n",
            "line 3: radius must be the same in all columns that give it, but is \"0.25 and 0.125\"",
        ),
        (
            "x,y,radius\n1,2,-0.5\n",
            "line 2 does not describe a disk: radius must be finite and positive, but is -0.5",
        ),
        (
            "x,y,radius\n1,inf,0.5\n",
            "line 2 does not describe a disk: position must be finite and at most 1e60 in magnitude, but is inf",
        ),
        (
            "x,y,radius,kind\n1,2,0.5,-1\n",
            "line 2: kind must be a whole number that fits into u16, but is \"-1\"",
        ),
        ("x,y,radius,id\n1,2,0.5,4\n3,2,0.5,3\n5,2,0.5,4\n", "line 4: the disk 4 is already in line 2"),
        ("x,y,radius\n1,2,0.5\n8,2,1\n1.75,2,0.5\n", OVERLAP),
    ];
    for (text, expected) in cases {
        assert_told(Reader::new().read_from(text.as_bytes()), expected);
    }
    assert_eq!(
        report(&Reader::new().read_from(&b"x,y,\xff\n"[..]).unwrap_err()),
        "line 1: the text must be UTF-8, but is \"x,y,\u{fffd}\""
    );
}

#[test]
fn faults_of_extended_xyz() {
    let keys = "Lattice=\"10 0 0 0 10 0 0 0 1\" pbc=\"F F F\" Properties=id:I:1:pos:R:3:radius:R:1";
    let told = |text: &str, expected: &str| assert_told(Reader::new().read_from(text.as_bytes()), expected);
    told("", "the file ends after line 0, where a frame should follow");
    told(
        "two\nProperties=pos:R:3\n",
        "line 1: the first line of a frame must be the number of its disks, but is \"two\"",
    );
    told("1\n", "the file ends after line 1, where the keys of a frame should follow");
    told(
        "1\nTime=1\n1 1 0 1\n",
        "line 2: the column `radius`, or one radius for all (with_radius, --radius), is missing",
    );
    told("two\nTime=1\n1 1 0 1\n", &UNKNOWN.replace("weight,height", "two"));
    told(
        "1\nProperties=pos:R:3\n1 1 0\n",
        "line 2: the column `radius`, or one radius for all (with_radius, --radius), is missing",
    );
    told(
        "0\nProperties=pos:R\n",
        "line 2: each of `Properties` must be a name, a type and a number, but is \"pos:R\"",
    );
    told(&format!("2\n{keys}\n1 1 1 0 0.5\n"), "the file ends after line 3, where disk 2 of 2 should follow");
    told(
        &format!("2\n{keys}\n1 1 1 2 0.5\n2 3 3 2.5 0.5\n"),
        "line 4: pos must be the same for all disks, which lie in a plane, but is \"2.5\"",
    );
    told(&format!("1\n{keys}\n1 1 11 0 0.5\n"), "line 3: the disk at (1.0, 11.0) is outside the box");
    told(
        &format!("2\n{keys}\n1 1 1 0 0.5\n2 1 1.5 0 0.5\n"),
        "line 4: the disk overlaps the disk of line 3 by 0.5, a share of 0.5 of their distance at contact; it \
         is the deepest of 1 such overlaps; set a tolerance or shrink the radii to accept them",
    );
    // The disks of a periodic box meet across its sides.
    let disks = "2\n{}\n1 0.25 1 0 0.5\n2 9.75 1 0 0.5\n";
    Reader::new().read_from(disks.replace("{}", keys).as_bytes()).unwrap();
    told(
        &disks.replace("{}", &keys.replace("F F F", "T F F")),
        "line 4: the disk overlaps the disk of line 3 by 0.5, a share of 0.5 of their distance at contact; it \
         is the deepest of 1 such overlaps; set a tolerance or shrink the radii to accept them",
    );
    told(
        &format!("0\n{}\n", keys.replace("F F F", "T x F")),
        "line 2: pbc must be three letters T or F, but is \"T x F\"",
    );
    told(&format!("0\n{keys} Time=now\n"), "line 2: Time must be a number, but is \"now\"");
    let skew = keys.replace("10 0 0 0", "10 1 0 0");
    for domain in ["3 1 0 9", "0 9 nan nan", "0 0 0 9"] {
        let text = format!("0\nDomain=\"{domain}\" Properties=id:I:1:pos:R:3:radius:R:1\n");
        let error = Reader::new().read_from(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("line 2: "), "{error}");
    }
    told(&format!("0\n{skew}\n"), "line 2: Lattice must be a rectangle, but is \"10 1 0 0 10 1 0 0 1\"");
    for (key, value) in [("Time", "nan"), ("Gravity", "inf"), ("Gravity", "-inf"), ("Time", "1e999")] {
        told(
            &format!("0\n{keys} {key}={value}\n"),
            &format!("line 2: {key} must be finite, but is {value:?}"),
        );
    }
    for domain in ["-inf 9 0 9", "0 inf 0 9", "0 9 -inf 9", "-1e308 1e308 0 9"] {
        let text = format!("0\nDomain=\"{domain}\" Properties=pos:R:2:radius:R:1\n");
        let error = Reader::new().read_from(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("line 2: the box must be from smaller to larger numbers"), "{error}");
    }
    let text = "0\nDomain=\"0 9 0 inf\" Properties=pos:R:2:radius:R:1 pbc=\"F T F\"\n";
    told(text, "line 2: the box must be from smaller to larger numbers, but is \"0 to 9 and 0 to inf\"");
    told(&format!("0\n{keys} Time=1 Time=2\n"), "line 2: the key `Time` is already in line 2");
    told(
        &format!("0\n{keys} Title=\"Time=1\n"),
        "line 2: the value of `Title` must be within two quotes, but is \"\\\"Time=1\"",
    );
    let one = "1\nProperties=pos:R:3:radius:R:1:a:R:1\n";
    for (row, count) in [("7 1 1 0 0.5 9", 6), ("1 1 0 0.5", 4)] {
        let told_count =
            format!("line 3: the number of values must be 5, one for each column, but is \"{count}\"");
        told(&format!("{one}{row}\n"), &told_count);
    }
    let own = one.replace("Properties", "Domain=\"0 9 0 9\" Properties");
    told(&format!("{own}1 1 0 0.5 3"), "the file ends after line 3, where a line break should follow");
    told(
        "9999999999999999999999\n",
        "line 1: the first line of a frame must be the number of its disks, but is \"9999999999999999999999\"",
    );
    told(
        &format!("18446744073709551615\n{keys}\n"),
        "the file ends after line 2, where disk 1 of 18446744073709551615 should follow",
    );
}

#[test]
fn frames_before_a_fault_are_read() {
    let text = "1\nProperties=pos:R:2:radius:R:1\n1 1 0.5\n1\nProperties=pos:R:2:radius:R:1\n1 1\n1\n";
    let frames: Vec<_> = Reader::new().frames(text.as_bytes()).unwrap().collect();
    assert_eq!(frames.len(), 2);
    assert!(frames[0].is_ok() && frames[1].is_err());
}

#[test]
fn faults_of_data_of_lammps() {
    let told = |text: &str, expected: &str| assert_told(Reader::new().read_from(text.as_bytes()), expected);
    let head = "t\n\n2 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n\n";
    let one = head.replace("2 atoms", "1 atoms");
    told("t\n\n0 9 xlo xhi\n0 9 ylo yhi\n", "line 4: the number of atoms is missing");
    told("t\n\n1 atoms\n0 9 xlo xhi\n", "line 4: `ylo yhi` is missing");
    told(
        "t\n\n1 atoms\n0 9 xlo xhi\n0 9 ylo yhi\n1 0 0 xy xz yz\n",
        "line 6: the box must be a rectangle, but is \"1 0 0 xy xz yz\"",
    );
    told(
        &format!("{head}Atoms # line\n\n1 1 0 0 0\n"),
        "line 8: the style of atoms must be `sphere`, but is \"line\"",
    );
    told(
        &format!("{one}Atoms\n\n1 1 0 0 0\n"),
        "line 10: an atom must be of 7 or 10 columns (id type diameter density x y z), but is \"1 1 0 0 0\"",
    );
    told(&format!("{one}Atoms\n\n1 0 1 1 2 2 0\n"), "line 10: type must be from 1 to 65536, but is \"0\"");
    told(
        &format!("{head}Atoms\n\n1 1 1 1 2 2 0\n"),
        "the file ends after line 10, where atom 2 of 2 should follow",
    );
    told(
        "t\n\n0 atoms\n9 0 xlo xhi\n0 9 ylo yhi\n",
        "line 5: the box must be from smaller to larger numbers, but is \"9 to 0 and 0 to 9\"",
    );
    told(&format!("{head}0 8 xlo xhi\n"), "line 8: `xlo xhi` is already in line 5");
    told(&head.replace("0 9 y", "-inf 9 y"), "line 6: a side of the box must be finite, but is \"-inf\"");
    let ours = head.replace("t\n\n2", "written by granular-edmd, time = nan\n\n0");
    told(&ours, "line 1: time must be finite, but is \"nan\"");
    // Words of another program in the title are no time.
    let other = head.replace("t\n\n2 atoms", "runtime = 7\n\n0 atoms");
    assert_eq!(Reader::new().read_from(other.as_bytes()).unwrap().time(), None);
    let atoms = format!("{head}Atoms\n\n2 1 1 1 2 2 0\n");
    told(&format!("{atoms}2 1 1 1 4 4 0\n"), "line 11: the atom 2 is already in line 10");
    told(
        &format!("{atoms}1 1 1 1 2.5 2 0\n"),
        "line 11: the disk overlaps the disk of line 10 by 0.5, a share of 0.5 of their distance at contact; it \
         is the deepest of 1 such overlaps; set a tolerance or shrink the radii to accept them",
    );
    told(&format!("{atoms}1 1 1 1 9.5 2 0\n"), "line 11: the disk at (9.5, 2.0) is outside the box");
    told(
        &format!("{atoms}1 1 0 1 4 2 0\n"),
        "line 11 does not describe a disk: radius must be finite and positive, but is 0",
    );
    let moving = format!("{atoms}1 1 1 1 4 4 0\n\nVelocities\n\n");
    told(&format!("{moving}3 0 0 0 0 0 0\n"), "line 15: the atom 3, which has a velocity here, is missing");
    told(
        &format!("{moving}1 0 0 1 0 0 0\n2 0 0 0 0 0 0\n"),
        "line 11: vz must be 0, for disks move in a plane, but is \"1\"",
    );
    told(
        &format!("{moving}1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n"),
        "line 16: the velocity of atom 1 is already in line 15",
    );
    // A file that was cut: the disk would be at rest.
    told(
        &format!("{moving}1 0 0 0 0 0 0\n"),
        "the file ends after line 15, where velocity 2 of 2 should follow",
    );
}

/// A line, or a header, that a few bytes can ask for, but no memory can hold.
#[test]
fn lines_are_bounded() {
    let endless = || std::io::repeat(b'1').take(1 << 40);
    let told = |read: Result<State, ReadError>, place: &str| {
        let error = report(&read.unwrap_err());
        assert!(
            error.starts_with(&format!("{place}: the line must be of fewer than 1048576 bytes")),
            "{error}"
        );
    };
    let input = |head: &'static str| std::io::BufReader::new(head.as_bytes().chain(endless()));
    told(Reader::new().read_from(input("")), "line 1");
    told(Reader::new().read_from(input("x,y,radius\n")), "line 2");
    told(Reader::new().read_from(input("1\n")), "line 2");
    told(Reader::new().read_from(input("title\n\n")), "line 3");
    for head in ["", "1\n", "1\nTime=1\n", "ITEM: UNITS\n"] {
        for format in [&ExtendedXyz as &dyn FrameFormat, &LammpsDump] {
            assert!(format.skip_frame(&mut input(head)).is_err(), "{head:?}");
        }
    }
    let columns = format!("0\nProperties=pos:R:2:radius:R:1{}\n", ":a:R:1000".repeat(2000));
    let error = Reader::new().read_from(columns.as_bytes()).unwrap_err().to_string();
    assert!(error.starts_with("line 2: `Properties` must be of at most 1000 columns"), "{error}");
}

/// Many small disks beside each other, and a giant that makes the other direction the longer one: the time
/// must not grow with the square of their number. By squares of all disks in one size, this took minutes.
#[test]
fn one_giant_does_not_slow_a_reader() {
    let mut text = String::from("x,y,radius\n1e6,0,5e5\n");
    for row in 0..100_000 {
        writeln!(text, "0,{row},0.5").unwrap();
    }
    let begun = std::time::Instant::now();
    assert_eq!(Reader::new().read_from(text.as_bytes()).unwrap().disks().len(), 100_001);
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
    text.push_str("0.25,99999.5,0.1\n");
    let told = report(&Reader::new().read_from(text.as_bytes()).unwrap_err());
    assert!(told.starts_with("line 100003: the disk overlaps the disk of line 10000"), "{told}");
}

/// Overlaps among disks of all sizes, in boxes of all sorts, are those that a loop over all pairs finds.
#[test]
fn overlaps_are_found() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut found = 0;
    for case in 0..400_u32 {
        let (sides, ends) = ([false, true][case as usize % 2], [false, true][case as usize / 2 % 2]);
        let mut domain = Domain::new(-3.0, 7.0, 0.0, 10.0);
        domain.periodic_sides = sides;
        domain.periodic_ends = ends;
        let disks: Vec<(f64, f64, f64)> = (0..generator.random_range(2..12))
            .map(|_| {
                let radius = 2.0 * 10_f64.powf(generator.random_range(-4.0..0.0));
                (generator.random_range(-3.0..7.0), generator.random_range(0.0..10.0), radius)
            })
            .collect();
        let letter = |is_periodic| if is_periodic { 'T' } else { 'F' };
        let keys = format!("Domain=\"-3 7 0 10\" pbc=\"{} {} F\"", letter(sides), letter(ends));
        let mut text = format!("{}\n{keys} Properties=pos:R:2:radius:R:1\n", disks.len());
        for (x, y, radius) in &disks {
            writeln!(text, "{x:?} {y:?} {radius:?}").unwrap();
        }
        let place = |disk: &(f64, f64, f64)| DVec2::new(disk.0, disk.1);
        let overlaps = disks.iter().enumerate().any(|(index, a)| {
            disks[..index].iter().any(|b| domain.separation(place(a), place(b)).length() < a.2 + b.2)
        });
        assert_eq!(Reader::new().read_from(text.as_bytes()).is_err(), overlaps, "{text}");
        found += usize::from(overlaps);
    }
    assert!((50..350).contains(&found), "{found} of 400");
}

/// Files with bytes changed, doubled and left out at random: they are read or refused, and nothing panics.
#[test]
fn damage_does_no_harm() {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(11);
    let domain = domain(1);
    let disks = &random_disks(3, &domain)[..5];
    let snapshot = Snapshot::new(0.5, disks, domain, 1.0);
    let mut files = [Vec::new(), Vec::new(), Vec::new()];
    ExtendedXyz.write_frame(&Frame::new(0, &snapshot), &mut files[0]).unwrap();
    State::of(&snapshot).write_csv(&mut files[1]).unwrap();
    State::of(&snapshot).write_lammps_data(&mut files[2]).unwrap();
    let mut refused = 0;
    for case in 0..6000 {
        let mut bytes = files[case % 3].clone();
        for _ in 0..generator.random_range(1..4) {
            let place = generator.random_range(0..bytes.len());
            match generator.random_range(0..4) {
                0 => bytes[place] = generator.random_range(32..127),
                1 => bytes[place] = *b"\n -e9.\"=#,".get(place % 11).unwrap_or(&b'0'),
                2 => drop(bytes.remove(place)),
                _ => bytes.insert(place, bytes[generator.random_range(0..bytes.len())]),
            }
        }
        let read = Reader::new().read_from(bytes.as_slice());
        refused += usize::from(read.is_err());
    }
    assert!((1000..5500).contains(&refused), "{refused} of 6000");
}
