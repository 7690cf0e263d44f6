//! Small files of GSD and of LAMMPS as their programs write them, with the values that they mean, or the
//! refusal.

use std::fs;
use std::path::PathBuf;

use granular_edmd::observable::SampleTimes;
use granular_edmd_files::{ByEnding, Reader, Recorder, State};

use crate::corpus::shown;
use crate::scratch::Scratch;
use support::cases::few;
use support::report::report;

pub(crate) fn path(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests/trajectory/files", name].iter().collect()
}

/// Checks what files say, without their paths in refusals.
#[track_caller]
fn check_files(reader: &Reader, cases: &[(&str, &str)]) {
    let wrong = cases.iter().filter_map(|(name, expected)| {
        let found = shown(reader.read(path(name)));
        let found = found.replace(&format!("cannot use {}: ", path(name).display()), "");
        (found != *expected).then(|| format!("{name}\n  should be {expected}\n  but is    {found}\n"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

const NAMED: &str = " | kinds are numbered by name: A 0, B 1";

/// `files/make_gsd.py` has made these by the package `gsd`.
#[test]
fn files_of_gsd() {
    let none = " | all diameters are 1, since the file has none";
    let plain = |kind| format!("-4..4p -3..3p; (-2 1) r0.5; (0 0) r0.5{kind}; (1.5 -1) r0.5{none}");
    check_files(
        &Reader::new(),
        &[
            ("hoomd_plain.gsd", "-4..4p -3..3p; (-2 1) r0.5; (0 0) r0.5"),
            (
                "hoomd_shapes.gsd",
                "-4..4p -3..3p; kinds 0 A, 1 B; (-2 1) r0.45; (0 0) r0.25 k1; (1.5 -1) r0.45 \
                 | kinds are numbered by name: A 0, B 1",
            ),
            (
                "hoomd_spheres.gsd",
                "refused: frame 0: the shapes must be in `particles/type_shapes`, not in `state/hpmc/sphere/radius`",
            ),
            (
                "hoomd_ellipsoids.gsd",
                "refused: frame 0: the shapes must be in `particles/type_shapes`, not in `state/hpmc/ellipsoid/a`",
            ),
            ("hoomd_polygons.gsd", "refused: frame 0: the shapes must be disks, but one is \"Polygon\""),
            (
                "hoomd_tilted.gsd",
                "refused: frame 0: the box must be a rectangle, but has the tilts 0.5, 0 and 0",
            ),
            (
                "hoomd_3d.gsd",
                "refused: frame 0, whose lines are its disks: line 2: pos must be the same for all disks, which lie in a plane, but is \"1\"",
            ),
            ("hoomd_plane_3d.gsd", &plain("")),
            ("hoomd_diameters_missing.gsd", &plain("")),
            ("names.gsd", &(plain(" k1").replace("(-2", "kinds 0 A, 1 B; (-2") + NAMED)),
            (
                "unused.gsd",
                &(plain(" k1")
                    + " | angular momenta are ignored, since the file has no moments of inertia | ignored: \
                       particles/charge, log/energy"),
            ),
            (
                "hoomd_overlap.gsd",
                "refused: frame 0, whose lines are its disks: line 3: the disk overlaps the disk of line 2 by 0.447224, a share of 0.198766 of their \
                 distance at contact; it is the deepest of 1 such overlaps; set a tolerance or shrink the radii to accept them",
            ),
            ("hoomd_empty.gsd", &format!("-4..4p -3..3p; {none}")),
            ("hoomd_none.gsd", "refused: the file ends after line 0, where a frame should follow"),
            (
                "hoomd_turning.gsd",
                &format!(
                    "-4..4p -3..3p; (-2 1) r0.5 a0.29999998999971866 w0.5000000023134882; (0 0) r0.5 \
                     a0.29999998999971866 w-1.0000000046269764; (1.5 -1) r0.5 a0.29999998999971866{none}"
                ),
            ),
            (
                "double.gsd",
                "-4..4p -3..3p; (-1.899999976158142 1.100000023841858) r0.5 i(1 0); (0.10000000149011612 \
                 0.10000000149011612) r0.25 k1 i(0 -3); (1.600000023841858 -0.8999999761581421) r0.5",
            ),
            (
                "ids.gsd",
                &format!(
                    "0..8p 0..6p; t 2.5; g [0, -1]; (2 4) r0.5 #5; (4 3) r0.5 k1 #2; (5.5 2) r0.5 #9{none}"
                ),
            ),
        ],
    );
}

#[test]
fn files_of_gsd_that_are_refused() {
    check_files(
        &Reader::new(),
        &[
            (
                "doubled_ids.gsd",
                "refused: frame 0, whose lines are its disks: line 3: the disk 5 is already in line 1",
            ),
            (
                "outside.gsd",
                "refused: frame 1, whose lines are its disks: line 1: the disk at (-2.0, 5.0) is outside the box",
            ),
            (
                "short.gsd",
                "refused: frame 0: the chunk `particles/diameter` has 2 rows of 1 numbers, not 3 of 1",
            ),
            (
                "flat.gsd",
                "refused: frame 0: the chunk `particles/position` has 3 rows of 2 numbers, not 3 of 3",
            ),
            ("no_positions.gsd", "refused: frame 0: the chunk `particles/position` is missing"),
            (
                "bad_radius.gsd",
                "refused: frame 0, whose lines are its disks: line 2 does not describe a disk: radius must be finite and positive, but is 0",
            ),
            (
                "bad_mass.gsd",
                "refused: frame 0, whose lines are its disks: line 2 does not describe a disk: mass must be finite and positive, but is -1",
            ),
            ("bad_time.gsd", "refused: frame 0: the chunk `log/time` must be finite, but is [NaN]"),
            (
                "bad_gravity.gsd",
                "refused: frame 0: the chunk `log/gravity` must be finite, but is [0.0, inf]",
            ),
            ("bad_center.gsd", "refused: frame 0: the chunk `log/center` must be finite, but is [NaN, 3.0]"),
            (
                "bad_domain.gsd",
                "refused: frame 0, whose lines are its disks: line 1: the box must be from smaller to larger numbers, but is \"0 to NaN and 0 to 6\"",
            ),
            (
                "moving_out.gsd",
                "refused: frame 0, whose lines are its disks: line 2: velo must be 0, for disks move in a plane, but is \"1\"",
            ),
            (
                "types.gsd",
                "refused: frame 0, whose lines are its disks: line 2: kind must be from 0 to 65535, but is \"70000\"",
            ),
            (
                "other_schema.gsd",
                "refused: GSD must be version 1 or 2 with the schema \"hoomd\", not 2 with the schema \"other\"",
            ),
        ],
    );
}

/// Where a file has no diameters or masses, the reader's settings count, and else what the file has.
#[test]
fn settings_for_files_of_gsd() {
    let reader = Reader::new().with_radius(0.25).unwrap();
    let plain = "-4..4p -3..3p; (-2 1) r0.25; (0 0) r0.25; (1.5 -1) r0.25";
    check_files(&reader, &[("hoomd_plane_3d.gsd", plain), ("hoomd_diameters_missing.gsd", plain)]);
    let reader = Reader::new().with_radius(0.1).unwrap().with_density(4.0).unwrap();
    let file = "-4..4p -3..3p; kinds 0 A, 1 B; (-2 1) r0.5 v(1 0) i(1 0); (0 0) r0.35 m0.49 v(0 2) k1; (1.5 -1) r0.5 i(-1 2) \
                | the radius that was given is ignored, since the file has radii | the density that was given is ignored, \
                since the file has masses".to_owned() + NAMED;
    check_files(&reader.clone().with_frame(0), &[("hoomd_plain.gsd", &file)]);
    let told = " | masses follow from the density, since the file has none (all may be 1)";
    let dense = plain.replace("r0.25", "r0.1 m0.12566370614359174");
    check_files(&reader, &[("hoomd_plane_3d.gsd", &format!("{dense}{told}"))]);
}

#[test]
fn frames_of_gsd_by_number_and_step() {
    let first = "-4..4p -3..3p; kinds 0 A, 1 B; (-2 1) r0.5 v(1 0) i(1 0); (0 0) r0.35 m0.49 v(0 2) k1; \
                 (1.5 -1) r0.5 i(-1 2)"
        .to_owned()
        + NAMED;
    let second =
        first.replace("(-2 1)", "(-1.75 1)").replace("(0 0)", "(0.25 0)").replace("(1.5 -1)", "(1.75 -1)");
    let last = "-4..4p -3..3p; (-2 1) r0.5; (0 0) r0.5";
    let none = |what| format!("refused: there is no frame with {what}: the file has 3");
    for (reader, expected) in [
        (Reader::new().with_frame(0), first.as_str()),
        (Reader::new().with_frame(1), &second),
        (Reader::new().with_frame(-2), &second),
        (Reader::new().with_step(100), &second),
        (Reader::new().with_frame(-1), last),
        (Reader::new().with_step(200), last),
        (Reader::new().with_frame(3), &none("number 3")),
        (Reader::new().with_frame(-4), &none("number -4")),
        (Reader::new().with_step(50), &none("step 50")),
    ] {
        check_files(&reader, &[("hoomd_plain.gsd", expected)]);
    }
    let wrapped = "-4..4p -3..3; (1 1) r0.5; (3 0) r0.5 k1; (-3.5 -1) r0.5 i(1 0) | all diameters are 1, since the file \
                   has none | disks outside of periodic sides, wrapped: 1";
    check_files(&Reader::new().with_frame(0), &[("outside.gsd", wrapped)]);
    // All frames one after another, from a stream.
    let bytes = fs::read(path("hoomd_plain.gsd")).unwrap();
    let frames: Result<Vec<State>, _> = Reader::new().frames(bytes.as_slice()).unwrap().collect();
    assert_eq!(frames.unwrap().iter().map(|state| state.disks().len()).collect::<Vec<_>>(), [3, 3, 2]);
}

/// Version 0.3 has made these. They are read; a recorder goes on in a dump with units, and refuses the rest.
#[test]
fn files_of_version_0_3() {
    let disks = "(2 1.875) r0.5 v(1 -0.25) a0.5 w0.5 #1; (3 2.375) r0.35 m0.49 v(0 -0.25) k3 #2";
    check_files(
        &Reader::new(),
        &[
            ("run_0_3.xyz", &format!("0..6p -0.1..inf; t 1; g [0, -0.25]; {disks}")),
            ("run_0_3.dump", &format!("0..6p -0.1..inf; t 1; {disks}")),
            (
                "run_0_3.gsd",
                "t 1; g [0, -0.25]; (2 1.8750000238418578) r0.5 v(1 -0.25) a0.5000000095033276 w0.5000000021900314 #1; \
                 (3 2.3749999046325683) r0.35 m0.49 v(0 -0.25) k3 #2 | the box is left out, since the file does not say \
                 where it is periodic",
            ),
        ],
    );
    let scratch = Scratch::new("old");
    let times = SampleTimes::every(0.5).unwrap();
    let copy = |name: &str| {
        fs::copy(path(name), scratch.path(name)).unwrap();
        scratch.path(name)
    };
    for (name, expected) in [
        (
            "run_0_3.xyz",
            "expected the columns of this version, but found \"id:I:1:species:S:1:pos:R:3:velo:R:3:angl\"",
        ),
        ("run_0_3.dump", "expected `ITEM: TIMESTEP`, but found \"ITEM: UNITS\""),
        (
            "run_0_3.gsd",
            "expected a GSD file by this version of granular-edmd, but found \"one of another version\"",
        ),
    ] {
        let path = copy(name);
        let error = report(&Recorder::append(&path, ByEnding, times).unwrap_err());
        assert!(error.ends_with(expected), "{error}");
        assert!(fs::read(&path).unwrap() == fs::read(self::path(name)).unwrap(), "{name} is left as it is");
    }
}

/// Cut at any byte, or with any byte changed, a file is read or refused: no panic, and no endless search.
#[test]
fn damaged_gsd_is_read_or_refused() {
    let bytes = fs::read(path("hoomd_plain.gsd")).unwrap();
    for cut in few(0..bytes.len(), 5) {
        let error = Reader::new().read_from(&bytes[..cut]).unwrap_err();
        assert!(!report(&error).is_empty(), "{cut}");
    }
    for place in few(0..bytes.len(), 5) {
        for byte in [1, 0xff] {
            let mut changed = bytes.clone();
            changed[place] ^= byte;
            let _ = Reader::new().read_from(changed.as_slice());
        }
    }
}

/// LAMMPS has made these: 22 Jul 2025, `atom_style sphere`, granular disks in the plane.
#[test]
fn starts_of_lammps() {
    for (name, count, periodic, depth) in [
        ("gas.data", 25, [true, true], 0.0),
        ("gravity.data", 25, [true, false], 3.617_204e-6),
        ("hybrid.data", 25, [true, true], 0.0),
        ("labels.data", 25, [true, true], 1.087_897e-4),
        ("prism.data", 25, [true, true], 0.0),
        ("prism_gas.data", 25, [true, true], 0.0),
        ("prism_walls.data", 25, [true, false], 0.0),
        ("stiff.data", 25, [true, true], 0.0),
        ("walls.data", 25, [false, false], 0.0),
    ] {
        let state = Reader::new().with_shrunk_radii().read(path(name)).unwrap();
        let domain = state.domain().unwrap();
        assert_eq!([domain.periodic_sides, domain.periodic_ends], periodic, "{name}");
        assert_eq!((domain.width(), domain.height(), state.disks().len()), (8.0, 8.0, count), "{name}");
        assert!((state.shrunk() - depth).abs() < 1e-9, "{name} {}", state.shrunk());
        assert_eq!(Reader::new().read(path(name)).is_err(), depth > 0.0, "{name}");
        // Each disk is as the text says, whatever the order.
        let text = fs::read_to_string(path(name)).unwrap();
        let (atoms, velocities) = text.split_once("Velocities").unwrap();
        let atoms = atoms.split_once("Atoms").unwrap().1;
        for disk in state.disks() {
            let row = |section: &str| -> Vec<f64> {
                let id = format!("{} ", disk.id());
                let row = section.lines().find(|line| line.starts_with(&id)).unwrap();
                row.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
            };
            let (mut atom, velocity) = (row(atoms), row(velocities));
            if name == "hybrid.data" {
                atom[2..7].rotate_left(3);
            }
            assert_eq!([disk.position().x, disk.position().y], [atom[4], atom[5]], "{name}");
            assert!((disk.radius() / (1.0 - state.shrunk()) - 0.5 * atom[2]).abs() < 1e-14);
            assert_eq!([disk.velocity().x, disk.velocity().y], [velocity[1], velocity[2]]);
            assert_eq!((disk.angular_velocity(), disk.kind().number()), (velocity[6], atom[1] as u16 - 1));
            assert!(
                (disk.mass() - 4.0 / 3.0 * std::f64::consts::PI * (0.5 * atom[2]).powi(3) * atom[3]).abs()
                    < 1e-14
            );
        }
    }
    for name in ["deep.data", "deep_2.data"] {
        let error = report(&Reader::new().read(path(name)).unwrap_err());
        assert!(error.contains("overlaps the disk of line"), "{error}");
    }
}

/// The recipes of the guide: each file has the disks of the last frame, as far as its program keeps them.
#[test]
#[ignore = "needs the files of other programs, which `.ci/readers` has them write"]
fn recipes_are_read_back() {
    let Ok(folder) = std::env::var("RECIPES") else {
        return eprintln!("SKIPPED: RECIPES does not name the folder of the recipes");
    };
    let folder = PathBuf::from(folder);
    let end = Reader::new().read(folder.join("end.csv")).unwrap();
    let (mut read, mut missing) = (0, Vec::new());
    // The largest error of a number, and whether angles and inertia factors are kept.
    for (name, error, is_whole) in [
        ("from_ovito.xyz", 4e-15, true),
        ("from_ase.xyz", 1e-8, true),
        ("from_pandas.csv", 0.0, true),
        ("from_polars.csv", 0.0, true),
        ("from_lammps.data", 1e-14, false),
        ("from_lammps.dump", 1e-15, false),
        ("from_gsd.gsd", 4e-6, true),
    ] {
        let Ok(state) = Reader::new().with_shrunk_radii().read(folder.join(name)) else {
            missing.push(name);
            continue;
        };
        assert!(state.shrunk() < 1e-6, "{name} {}", state.shrunk());
        assert_eq!(state.disks().len(), end.disks().len(), "{name}");
        for disk in end.disks() {
            let back = state.disks().iter().find(|back| back.id() == disk.id()).unwrap();
            let near = |one: f64, other: f64| assert!((one - other).abs() <= error, "{name}: {one} {other}");
            near(back.position().x, disk.position().x);
            near(back.position().y, disk.position().y);
            near(back.velocity().x, disk.velocity().x);
            near(back.velocity().y, disk.velocity().y);
            near(back.angular_velocity(), disk.angular_velocity());
            near(back.mass(), disk.mass());
            assert!((back.radius() - disk.radius()).abs() < 1e-7, "OVITO keeps radii in single precision");
            assert_eq!(back.kind(), disk.kind(), "{name}");
            if is_whole {
                assert!((0.5 * (back.angle() - disk.angle())).sin().abs() <= error.max(1e-15), "{name}");
                near(back.inertia_factor(), disk.inertia_factor());
            }
        }
        read += 1;
    }
    assert!(read > 0, "{missing:?} cannot be read");
    println!("{read} files are read back; not there: {missing:?}");
}
