//! Small frames of extended XYZ as other programs write them.

use granular_edmd_files::Reader;

use crate::corpus::{check, xyz};

/// Checks frames of extended XYZ: keys, rows, and what they say.
#[track_caller]
fn check_xyz(cases: &[[&str; 3]]) {
    let texts: Vec<String> = cases.iter().map(|[keys, rows, _]| xyz(keys, rows)).collect();
    let cases: Vec<(&str, &str)> =
        texts.iter().map(String::as_str).zip(cases.iter().map(|case| case[2])).collect();
    check(&Reader::new(), &cases);
}

#[test]
fn columns_of_extended_xyz() {
    check_xyz(&[
        ["Properties=pos:R:2:radius:R:1", "1 2 0.5", "(1 2) r0.5"],
        ["Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1", "0 1 2 0 3 4 0 0.5", "(1 2) r0.5 v(3 4)"],
        ["Properties=pos:R:2:vel:R:2:radius:R:1", "1 2 3 4 0.5", "(1 2) r0.5 v(3 4)"],
        ["Properties=Position:R:2:Velocity:R:2:Radius:R:1", "1 2 3 4 0.5", "(1 2) r0.5 v(3 4)"],
        ["Properties=radii:R:1:v:R:2:pos:R:2", "0.5 3 4 1 2", "(1 2) r0.5 v(3 4)"],
        ["Properties=pos:R:3:diameter:R:1", "1 2 0 1", "(1 2) r0.5"],
        ["Properties=pos:R:3:d:R:1:m:R:1", "1 2 0 1 3", "(1 2) r0.5 m3"],
        // ASE has masses and momenta.
        [
            "Properties=species:S:1:pos:R:3:masses:R:1:momenta:R:3:radius:R:1",
            "H 1 2 0 2 3 4 0 0.5",
            "kinds 0 H; (1 2) r0.5 m2 v(1.5 2) | kinds are numbered by name: H 0",
        ],
        // OVITO has the angular velocity as a vector, and the orientation as a quaternion.
        ["Properties=pos:R:3:radius:R:1:omega:R:3", "1 2 0 0.5 0 0 0.75", "(1 2) r0.5 w0.75"],
        ["Properties=pos:R:3:radius:R:1:angular_velocity:R:3", "1 2 0 0.5 0 0 9", "(1 2) r0.5 w9"],
        ["Properties=pos:R:3:radius:R:1:angular_velocity:R:1", "1 2 0 0.5 9", "(1 2) r0.5 w9"],
        ["Properties=pos:R:3:radius:R:1:omegaz:R:1", "1 2 0 0.5 -1", "(1 2) r0.5 w-1"],
        [
            "Properties=pos:R:3:radius:R:1:orientation:R:4",
            "1 2 0 0.5 0 0 1 0",
            "(1 2) r0.5 a3.141592653589793",
        ],
        ["Properties=pos:R:3:radius:R:1:orientation:R:1", "1 2 0 0.5 0.25", "(1 2) r0.5 a0.25"],
        [
            "Properties=pos:R:3:radius:R:1:angle:R:1:orientation:R:4",
            "1 2 0 0.5 9.42477796076938 0 0 -1 0",
            "(1 2) r0.5 a9.42477796076938",
        ],
        [
            "Properties=pos:R:3:radius:R:1:image:I:3:inertia_factor:R:1",
            "1 2 0 0.5 -1 2 0 1",
            "(1 2) r0.5 b1 i(-1 2)",
        ],
        ["Properties=id:I:1:type:I:1:pos:R:3:radius:R:1", "7 3 1 2 0 0.5", "(1 2) r0.5 k3 #7"],
        ["Properties=pos:R:2:radius:R:1:density:R:1", "1 2 0.5 4", "(1 2) r0.5 m3.141592653589793"],
        [
            "Properties=pos:R:2:radius:R:1:forces:R:3:tag:S:1",
            "1 2 0.5 9 9 9 word",
            "(1 2) r0.5 | ignored: forces, tag",
        ],
        // Numbers as Fortran and C write them.
        ["Properties=pos:R:3:radius:R:1", "1.0D+00 +2. 0 .5d0", "(1 2) r0.5"],
        // A plain XYZ has no radii.
        [
            "a comment",
            "H 1 2 0",
            "refused: line 2: the column `radius`, or one radius for all (with_radius, --radius), is missing",
        ],
    ]);
}

#[test]
fn kinds_by_names() {
    check_xyz(&[
        [
            "Properties=species:S:1:pos:R:3:radius:R:1",
            "steel 1 1 0 0.5 / glass 3 1 0 0.5 / steel 5 1 0 0.5",
            "kinds 0 glass, 1 steel; (1 1) r0.5 k1; (3 1) r0.5; (5 1) r0.5 k1 \
             | kinds are numbered by name: glass 0, steel 1",
        ],
        [
            "Properties=species:S:1:pos:R:3:radius:R:1",
            "3 1 1 0 0.5 / 1 3 1 0 0.5",
            "(1 1) r0.5 k3; (3 1) r0.5 k1",
        ],
        [
            "Properties=species:S:1:kind:I:1:pos:R:3:radius:R:1",
            "X 3 1 1 0 0.5 / X 1 3 1 0 0.5",
            "(1 1) r0.5 k3; (3 1) r0.5 k1",
        ],
        [
            "Properties=kind:I:1:pos:R:3:radius:R:1",
            "steel 1 1 0 0.5",
            "refused: line 3: kind must be a whole number that \
          fits into u16, but is \"steel\"",
        ],
        [
            "Properties=type:S:1:pos:R:3:radius:R:1",
            "A 1 1 0 0.5 / B 3 1 0 0.5",
            "kinds 0 A, 1 B; (1 1) r0.5; (3 1) r0.5 k1 | kinds are numbered by name: A 0, B 1",
        ],
        [
            "Properties=species:S:1:type:I:1:pos:R:3:radius:R:1",
            "A 70000 1 1 0 0.5",
            "refused: line 3: type must be from 0 to 65535, but is \"70000\"",
        ],
    ]);
}

#[test]
fn ids_from_zero_stay_different() {
    check_xyz(&[
        [
            "Properties=id:I:1:pos:R:2:radius:R:1",
            "2 1 1 0.5 / 0 3 1 0.5 / 1 5 1 0.5",
            "(1 1) r0.5 #3; (3 1) r0.5 #1; (5 1) r0.5 #2 | ids begin with 0 in the file, and are greater by 1 here",
        ],
        [
            "Properties=id:I:1:pos:R:2:radius:R:1",
            "0 1 1 0.5 / 0 3 1 0.5",
            "refused: line 4: the disk 0 is already in line 3",
        ],
        [
            "Properties=id:I:1:pos:R:2:radius:R:1",
            "9007199254740993 1 1 0.5",
            "refused: line 3: id must be at most 2^53, \
          but is \"9007199254740993\"",
        ],
    ]);
}

#[test]
fn keys_of_extended_xyz() {
    let one = |keys: &str| xyz(&format!("Properties=pos:R:2:radius:R:1 {keys}"), "1 2 0.5");
    let told = "all sides of the lattice are periodic, since the file has no `pbc`";
    let periodic = format!("0..10p 0..5p; (1 2) r0.5 | {told}");
    let cases = [
        ("Lattice=\"10 0 0 0 5 0 0 0 1\"", periodic.as_str()),
        ("Lattice=\"10 0 0 0 5 0 0 0 1\" pbc=\"T F F\"", "0..10p 0..5; (1 2) r0.5"),
        ("Lattice=\"10 0 0 0 5 0 0 0 1\" PBC=[true, False, F]", "0..10p 0..5; (1 2) r0.5"),
        ("lattice='10 0 0 0 5 0 0 0 1' pbc=\"0 1\"", "0..10 0..5p; (1 2) r0.5"),
        ("Lattice=[[10, 0, 0], [0, 5, 0], [0, 0, 1]]", periodic.as_str()),
        ("Lattice={10 0 0 0 5 0 0 0 1}", periodic.as_str()),
        ("Lattice=\"10,0,0,0,5,0,0,0,1\"", periodic.as_str()),
        ("Lattice = [10, 5, 1]", periodic.as_str()),
        ("Lattice=\"10 0 0 5\"", periodic.as_str()),
        ("Lattice=\"10 6e-16 0 0 5 0 0 0 1\"", periodic.as_str()),
        ("Lattice=\"10 0 0 0 5 0 0 0 1\" Origin=\"-2 1 0\" pbc=\"F F F\"", "-2..8 1..6; (1 2) r0.5"),
        (
            "Lattice=\"10 1 0 0 5 0 0 0 1\"",
            "refused: line 2: Lattice must be a rectangle, but is \"10 1 0 0 5 0 0 0 1\"",
        ),
        (
            "Lattice=\"10 0 0 0 5\"",
            "refused: line 2: Lattice must be 2, 3, 4 or 9 numbers, but is \"10 0 0 0 5\"",
        ),
        ("Time=3", "t 3; (1 2) r0.5"),
        ("time=3", "t 3; (1 2) r0.5"),
        ("t=3.5", "t 3.5; (1 2) r0.5"),
        ("Time = 3", "t 3; (1 2) r0.5"),
        ("Time=3 t=3", "t 3; (1 2) r0.5"),
        ("Time=3 t=4", "refused: line 2: the key `t` is already in line 2"),
        ("Gravity=\"0.5 -1\"", "g [0.5, -1]; (1 2) r0.5"),
        ("gravity=2", "g [0, -2]; (1 2) r0.5"),
        ("Title=", "(1 2) r0.5 | ignored: Title"),
        ("T = 300 K", "(1 2) r0.5 | ignored: T"),
        ("energy=-3 energy=4 note=\"a \\\"word\\\" Time=9\" flag", "(1 2) r0.5 | ignored: energy, note"),
    ];
    let texts: Vec<String> = cases.iter().map(|(keys, _)| one(keys)).collect();
    let cases: Vec<(&str, &str)> =
        texts.iter().map(String::as_str).zip(cases.iter().map(|case| case.1)).collect();
    check(&Reader::new(), &cases);
}

#[test]
fn disks_lie_in_a_plane() {
    check_xyz(&[
        ["Properties=pos:R:3:radius:R:1", "1 2 0.5 0.5 / 3 2 0.5 0.5", "(1 2) r0.5; (3 2) r0.5"],
        ["Properties=pos:R:3:radius:R:1", "1 2 1e-17 0.5 / 3 2 -1e-17 0.5", "(1 2) r0.5; (3 2) r0.5"],
        [
            "Properties=pos:R:3:radius:R:1",
            "1 2 0 0.5 / 3 2 0.1 0.5",
            "refused: line 4: pos must be the same for all disks, \
          which lie in a plane, but is \"0.1\"",
        ],
        ["Properties=pos:R:3:radius:R:1:vel:R:3", "1 2 0 0.5 1 0 1e-12", "(1 2) r0.5 v(1 0)"],
        [
            "Properties=pos:R:3:radius:R:1:vel:R:3",
            "1 2 0 0.5 1 0 1",
            "refused: line 3: vel must be 0, for disks move in a \
          plane, but is \"1\"",
        ],
        [
            "Properties=pos:R:3:radius:R:1:omega:R:3",
            "1 2 0 0.5 1 0 1",
            "refused: line 3: omega must be 0, for disks move \
          in a plane, but is \"1\"",
        ],
    ]);
}

#[test]
fn columns_that_contradict_each_other() {
    check_xyz(&[
        ["Properties=pos:R:2:radius:R:1:diameter:R:1", "1 2 0.333333 0.666667", "(1 2) r0.333333"],
        [
            "Properties=pos:R:2:radius:R:1:diameter:R:1",
            "1 2 0.5 0.5",
            "refused: line 3: radius must be the same in all \
          columns that give it, but is \"0.5 and 0.25\"",
        ],
        ["Properties=pos:R:2:radius:R:1:vel:R:2:velo:R:2", "1 2 0.5 3 4 3 4", "(1 2) r0.5 v(3 4)"],
        [
            "Properties=pos:R:2:radius:R:1:vel:R:2:velo:R:2",
            "1 2 0.5 3 4 4 4",
            "refused: line 3: velo must be the same in \
          all columns that give it, but is \"3 and 4\"",
        ],
        [
            "Properties=pos:R:2:radius:R:1:vel:R:2:momenta:R:2:mass:R:1",
            "1 2 0.5 3 4 6 8 1",
            "refused: line 3: velocity \
          must be the same in all columns that give it, but is \"3 and 6\"",
        ],
        [
            "Properties=pos:R:2:radius:R:1:angle:R:1:orientation:R:4",
            "1 2 0.5 1 0 0 1 0",
            "refused: line 3: angle must be \
          the same in all columns that give it, but is \"1, and another one in the orientation\"",
        ],
        [
            "Properties=pos:R:2:pos:R:2:radius:R:1",
            "1 2 1 3 0.5",
            "refused: line 3: pos must be the same in all columns that give it, but is \"2 and 3\"",
        ],
    ]);
}
