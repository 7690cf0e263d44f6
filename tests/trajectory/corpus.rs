//! Small files as other programs and people write them, with the values that they mean, or the refusal.

use std::fmt::Write as _;

use granular_edmd::trajectory::{ReadError, Reader, State};
use granular_edmd::{Disk, Gravity};

use crate::report::report;

/// Writes what a file says: box, time and gravity if it has them; then each disk, without what is as in
/// [`Disk::new`]; then the notes.
pub(crate) fn shown(read: Result<State, ReadError>) -> String {
    let state = match read {
        Ok(state) => state,
        Err(error) => return format!("refused: {}", report(&error)),
    };
    let mut text = String::new();
    if let Some(domain) = state.domain() {
        let letter = |is_periodic| if is_periodic { "p" } else { "" };
        let (sides, ends) = (letter(domain.periodic_sides), letter(domain.periodic_ends));
        let (x, y) = ([domain.left, domain.right], [domain.bottom, domain.top]);
        write!(text, "{}..{}{sides} {}..{}{ends}; ", x[0], x[1], y[0], y[1]).unwrap();
    }
    state.time().map(|time| write!(text, "t {time}; ").unwrap());
    state.gravity().map(|gravity: Gravity| write!(text, "g {}; ", gravity.acceleration()).unwrap());
    let mut kinds = state.kind_names().iter().enumerate().map(|(number, name)| format!("{number} {name}"));
    kinds.next().map(|first| {
        write!(text, "kinds {first}{}; ", kinds.map(|kind| format!(", {kind}")).collect::<String>()).unwrap()
    });
    text += &state.disks().iter().map(shown_disk).collect::<Vec<_>>().join("; ");
    state.notes().iter().for_each(|note| write!(text, " | {note}").unwrap());
    text
}

fn shown_disk(disk: &Disk) -> String {
    let position = disk.position();
    let mut text = format!("({} {}) r{}", position.x, position.y, disk.radius());
    let mut add = |is_other: bool, what: String| {
        if is_other {
            text += &format!(" {what}");
        }
    };
    let (velocity, [right, up]) = (disk.velocity(), disk.image());
    add(disk.mass() != 1.0, format!("m{}", disk.mass()));
    add(velocity.length() != 0.0, format!("v({} {})", velocity.x, velocity.y));
    add(disk.angle() != 0.0, format!("a{}", disk.angle()));
    add(disk.angular_velocity() != 0.0, format!("w{}", disk.angular_velocity()));
    add(disk.inertia_factor() != 0.5, format!("b{}", disk.inertia_factor()));
    add(disk.kind().number() != 0, format!("k{}", disk.kind().number()));
    add(disk.image() != [0, 0], format!("i({right} {up})"));
    add(disk.id() != 0, format!("#{}", disk.id()));
    text
}

/// Checks what files say.
#[track_caller]
pub(crate) fn check(reader: &Reader, cases: &[(&str, &str)]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(text, expected)| {
            let found = shown(reader.read_from(text.as_bytes()));
            (found != *expected).then(|| format!("{text}\n  should be {expected}\n  but is    {found}\n"))
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

/// Returns the text of a frame with these keys and this row, or these rows with `/` between them.
fn xyz(keys: &str, rows: &str) -> String {
    let rows: Vec<&str> = rows.split('/').map(str::trim).collect();
    format!("{}\n{keys}\n{}\n", rows.len(), rows.join("\n"))
}

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
            "kinds 0 H; (1 2) r0.5 m2 v(1.5 2)",
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
            "(1 2) r0.5 | ignored columns: forces, tag",
        ],
        // Numbers as Fortran and C write them.
        ["Properties=pos:R:3:radius:R:1", "1.0D+00 +2. 0 .5d0", "(1 2) r0.5"],
        // A plain XYZ has no radii.
        ["a comment", "H 1 2 0", "refused: line 2: the column `radius` is missing"],
    ]);
}

#[test]
fn kinds_by_names() {
    check_xyz(&[
        [
            "Properties=species:S:1:pos:R:3:radius:R:1",
            "steel 1 1 0 0.5 / glass 3 1 0 0.5 / steel 5 1 0 0.5",
            "kinds 0 steel, 1 glass; (1 1) r0.5; (3 1) r0.5 k1; (5 1) r0.5",
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
            "Properties=type:I:1:pos:R:3:radius:R:1",
            "70000 1 1 0 0.5",
            "refused: line 3: type must be from 0 to 65535, \
          but is \"70000\"",
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
            "refused: line 4: the disk 0 stands in line 3 \
          already",
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
    let told = "all sides of the lattice are periodic, for the file has no `pbc`";
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
        ("Time=3 t=4", "refused: line 2: the key `t` stands in line 2 already"),
        ("Gravity=\"0.5 -1\"", "g [0.5, -1]; (1 2) r0.5"),
        ("gravity=2", "g [0, -2]; (1 2) r0.5"),
        ("energy=-3 energy=4 note=\"a \\\"word\\\" Time=9\" flag", "(1 2) r0.5"),
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
          columns that tell it, but is \"0.5 and 0.25\"",
        ],
        ["Properties=pos:R:2:radius:R:1:vel:R:2:velo:R:2", "1 2 0.5 3 4 3 4", "(1 2) r0.5 v(3 4)"],
        [
            "Properties=pos:R:2:radius:R:1:vel:R:2:velo:R:2",
            "1 2 0.5 3 4 4 4",
            "refused: line 3: velo must be the same in \
          all columns that tell it, but is \"3 and 4\"",
        ],
        [
            "Properties=pos:R:2:radius:R:1:vel:R:2:momenta:R:2:mass:R:1",
            "1 2 0.5 3 4 6 8 1",
            "refused: line 3: velocity \
          must be the same in all columns that tell it, but is \"3 and 6\"",
        ],
        [
            "Properties=pos:R:2:radius:R:1:angle:R:1:orientation:R:4",
            "1 2 0.5 1 0 0 1 0",
            "refused: line 3: angle must be \
          the same in all columns that tell it, but is \"1 and that of the orientation\"",
        ],
        [
            "Properties=pos:R:2:pos:R:2:radius:R:1",
            "1 2 1 2 0.5",
            "refused: line 2: the column `pos` stands in line 2 \
          already",
        ],
    ]);
}

#[test]
fn tables_of_many_programs() {
    check(
        &Reader::new(),
        &[
            ("x,y,radius\n1,2,0.5\n", "(1 2) r0.5"),
            ("Y,X,R\n2,1,0.5\n", "(1 2) r0.5"),
            // pandas and R have a column of their own.
            (
                ",x,y,radius\n0,1,2,0.5\n1,3,2,0.5\n",
                "(1 2) r0.5; (3 2) r0.5 | ignored columns: (without a name)",
            ),
            (
                "\"\",\"x\",\"y\",\"radius\"\n\"1\",1,2,0.5\n",
                "(1 2) r0.5 | ignored columns: (without a name)",
            ),
            ("x;y;d;weight\n1;2;1;9\n", "(1 2) r0.5 | ignored columns: weight"),
            ("x\ty\tradius\tvx\tvy\n1\t2\t0.5\t3\t4\n", "(1 2) r0.5 v(3 4)"),
            ("# x y radius omega\n1 2 0.5 3\n# the end\n", "(1 2) r0.5 w3"),
            ("x, y, radius, angle\n1, 2, 0.5, 3\n", "(1 2) r0.5 a3"),
            ("id,x,y,radius\n1.0,1,2,0.5\n", "(1 2) r0.5 #1"),
            ("x,y,z,radius\n1,2,0,0.5\n", "(1 2) r0.5"),
            ("pos_x,pos_y,vel_x,vel_y,radius\n1,2,3,4,0.5\n", "(1 2) r0.5 v(3 4)"),
            // OVITO's and ParaView's tables.
            (
                "\"Particle Identifier\" \"Particle Type\" \"Position.X\" \"Position.Y\" \"Position.Z\" Radius\n4 2 1 2 0 0.5\n",
                "(1 2) r0.5 k2 #4",
            ),
            (
                "\"radius\",\"velocity:0\",\"velocity:1\",\"velocity:2\",\"Points:0\",\"Points:1\",\"Points:2\"\n0.5,3,4,0,1,2,0\n",
                "(1 2) r0.5 v(3 4)",
            ),
            (
                "x,y,radius,species\n1,2,0.5,\"a, b\"\n3,2,0.5,c\n",
                "kinds 0 a, b, 1 c; (1 2) r0.5; (3 2) r0.5 k1",
            ),
            ("x,y,radius,mass\r\n1,2,0.5,2\r\n", "(1 2) r0.5 m2"),
            (
                "x,y,radius\n1,2,0.5\n3,2,0.5",
                "(1 2) r0.5; (3 2) r0.5 | the last line has no line break: its last number may be cut",
            ),
            (
                "x,y,radius\n1,2,0.5\n3,2",
                "refused: line 3: the number of values must be 3, one for each column, but is \"2\"",
            ),
            ("x,y,radius\n1,,0.5\n", "refused: line 2: y must be a number, but is \"\""),
            ("x,radius\n1,0.5\n", "refused: line 1: the column `y` is missing"),
            (
                "x,y,radius\n1,2,0.5\n1,2,0.5\n3,2,0.5\n3.5,2,0.5\n",
                "refused: line 3: the disk overlaps the disk of line 2 by \
          1, a share of 1 of their distance at contact; it is the deepest of 2 such overlaps; a tolerance or shrunk \
          radii accept them",
            ),
        ],
    );
}

/// Returns a dump with these columns and rows, of a box of 10 by 5.
fn dump(columns: &str, rows: &str) -> String {
    let rows: Vec<&str> = rows.split('/').map(str::trim).collect();
    format!(
        "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp ff pp\n0 10\n0 5\n-0.5 0.5\n\
         ITEM: ATOMS {columns}\n{}\n",
        rows.len(),
        rows.join("\n")
    )
}

#[test]
fn dumps_of_lammps_and_liggghts() {
    let cases = [
        ("id type x y z radius", "3 1 1 2 0 0.5", "(1 2) r0.5 #3"),
        ("id type xs ys zs diameter", "3 2 0.25 0.5 0.5 1", "(2.5 2.5) r0.5 k1 #3"),
        // Unwrapped positions have the periods that were passed.
        ("id xu yu radius", "3 21 2 0.5", "(1 2) r0.5 i(2 0) #3"),
        ("id xu yu ix iy radius", "3 21 2 2 0 0.5", "(1 2) r0.5 i(2 0) #3"),
        ("id x y xu yu radius", "3 1 2 -9 2 0.5", "(1 2) r0.5 i(-1 0) #3"),
        ("id xsu ysu radius", "3 1.25 0.5 0.5", "(2.5 2.5) r0.5 i(1 0) #3"),
        (
            "id x y ix xu radius",
            "3 1 2 2 11 0.5",
            "refused: line 10: x must be the same in all columns that tell it, but is \"21 and 11\"",
        ),
        (
            "id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius",
            "1 1 1 1 2 0 0 0 0 3 4 0 9 9 9 0 0 5 0.5",
            "refused: line 9: the column `type` stands in line 9 already",
        ),
        (
            "id type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius",
            "1 1 1 2 0 0 0 0 3 4 0 9 9 9 0 0 5 0.5",
            "(1 2) r0.5 v(3 4) w5 #1 | ignored columns: fx, fy, fz",
        ),
        ("id x y radius density", "1 1 2 0.5 6", "(1 2) r0.5 m3.141592653589793 #1"),
        ("id x y radius c_one[1] v_two", "1 1 2 0.5 9 9", "(1 2) r0.5 #1 | ignored columns: c_one[1], v_two"),
        ("id type element x y radius", "1 2 Fe 1 2 0.5", "(1 2) r0.5 k1 #1 | ignored columns: element"),
        ("id element x y radius", "1 Fe 1 2 0.5", "kinds 0 Fe; (1 2) r0.5 #1"),
        // Rows stay in the order of the file.
        ("id x y radius", "2 1 2 0.5 / 1 3 2 0.5", "(1 2) r0.5 #2; (3 2) r0.5 #1"),
        // Disks outside of periodic sides are wrapped, others are not.
        (
            "id x y radius",
            "1 11 2 0.5 / 2 -7 2 0.5",
            "(1 2) r0.5 i(1 0) #1; (3 2) r0.5 i(-1 0) #2 | disks outside of periodic sides, wrapped: 2",
        ),
        ("id x y radius", "1 1 6 0.5", "refused: line 10: the disk at (1, 6) is outside the box"),
        ("id type x y radius", "1 0 1 2 0.5", "refused: line 10: type must be from 1 to 65536, but is \"0\""),
        ("id type x y", "1 1 1 2", "refused: line 9: the column `radius` is missing"),
        (
            "id x y z radius",
            "1 1 2 0 0.5 / 2 3 2 0.5",
            "refused: line 11: the number of values must be 5, one for each \
          column, but is \"4\"",
        ),
    ];
    let texts: Vec<String> = cases.iter().map(|(columns, rows, _)| dump(columns, rows)).collect();
    let expected: Vec<String> =
        cases
            .iter()
            .map(|(.., said)| {
                if said.starts_with("refused") { (*said).to_owned() } else { format!("0..10p 0..5; {said}") }
            })
            .collect();
    let cases: Vec<(&str, &str)> =
        texts.iter().map(String::as_str).zip(expected.iter().map(String::as_str)).collect();
    check(&Reader::new(), &cases);
}

#[test]
fn boxes_of_dumps() {
    let of = |bounds: &str| dump("x y radius", "1 2 0.5").replace("pp ff pp\n0 10\n0 5\n-0.5 0.5", bounds);
    let cases = [
        ("pp pp pp\n0 10\n0 5\n-1 1", "0..10p 0..5p; (1 2) r0.5"),
        ("ff fs pp\n0 10\n0 5\n-1 1", "0..10 0..inf; (1 2) r0.5"),
        ("xy xz yz pp pp pp\n0 10 0\n0 5 0\n-1 1 0", "0..10p 0..5p; (1 2) r0.5"),
        ("abc origin pp pp pp\n10 0 0 0\n0 5 0 0\n0 0 1 -0.5", "0..10p 0..5p; (1 2) r0.5"),
        (
            "\n0 10\n0 5\n-1 1",
            "0..10 0..5; (1 2) r0.5 | no side is periodic, for the dump does not say which are",
        ),
        (
            "xy xz yz pp pp pp\n0 10 1\n0 5 0\n-1 1 0",
            "refused: line 6: the box must be a rectangle, but is \"0 10 1\"",
        ),
        (
            "pp pp pp\n10 0\n0 5\n-1 1",
            "refused: line 7: the box must be from smaller to larger numbers, but is \"10 to 0 \
          and 0 to 5\"",
        ),
        ("pp pp pp\n0 ten\n0 5\n-1 1", "refused: line 6: a side of the box must be a number, but is \"ten\""),
    ];
    let texts: Vec<String> = cases.iter().map(|(bounds, _)| of(bounds)).collect();
    let cases: Vec<(&str, &str)> =
        texts.iter().map(String::as_str).zip(cases.iter().map(|case| case.1)).collect();
    check(&Reader::new(), &cases);
    let one = dump("x y radius", "1 2 0.5");
    let timed = format!("ITEM: UNITS\nlj\nITEM: TIME\n2.5\n{one}");
    check(
        &Reader::new(),
        &[
            (&timed, "0..10p 0..5; t 2.5; (1 2) r0.5"),
            (
                one.trim_end(),
                "0..10p 0..5; (1 2) r0.5 | the last line has no line break: its last number may be cut",
            ),
            (
                &one.replace("ATOMS\n1", "ATOMS\n2"),
                "refused: the file ends after line 10, where disk 2 of 2 should follow",
            ),
            (
                &one.replace("ITEM: NUMBER OF ATOMS\n1\n", ""),
                "refused: line 7: `ITEM: NUMBER OF ATOMS` is missing",
            ),
            (
                "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n0\n",
                "refused: line 3: a line between frames must be `ITEM:` with \
          TIMESTEP, TIME, UNITS, NUMBER OF ATOMS, BOX BOUNDS or ATOMS, but is \"ITEM: NUMBER OF ENTRIES\"",
            ),
        ],
    );
}

#[test]
fn frames_by_number_and_step() {
    let frame =
        |step: u32, x: &str| dump("x y radius", &format!("{x} 2 0.5")).replace("100", &step.to_string());
    // The first frame overlaps, and the second is out of its box: only a frame that is asked for is checked.
    let text = frame(0, "1 2 0.5 / 1") + &frame(100, "1 9 0.5 / 1") + &frame(200, "5");
    let of = |reader: Reader| shown(reader.read_from(text.as_bytes()));
    let last = "0..10p 0..5; (5 2) r0.5";
    assert_eq!(of(Reader::new()), last);
    assert_eq!(of(Reader::new().with_frame(2)), last);
    assert_eq!(of(Reader::new().with_frame(-1)), last);
    assert_eq!(of(Reader::new().with_step(200)), last);
    assert!(
        of(Reader::new().with_frame(0))
            .starts_with("refused: line 11: the disk overlaps the disk of line 10")
    );
    assert!(of(Reader::new().with_frame(-2)).starts_with("refused: line 21: the disk at (1, 9) is outside"));
    assert_eq!(of(Reader::new().with_frame(3)), "refused: there is no frame of number 3: the file has 3");
    assert_eq!(of(Reader::new().with_frame(-4)), "refused: there is no frame of number -4: the file has 3");
    assert_eq!(of(Reader::new().with_step(7)), "refused: there is no frame of step 7: the file has 3");
    let states: Vec<_> =
        Reader::new().with_tolerance(1.0).unwrap().frames(text.as_bytes()).unwrap().collect();
    assert_eq!(states.len(), 2);
    assert!(states[0].is_ok() && states[1].is_err());
}

#[test]
fn soft_disks() {
    let text = "x,y,radius\n1,2,0.5\n1.99,2,0.5\n2.9899,2,0.5\n";
    let of = |reader: Reader| shown(reader.read_from(text.as_bytes()));
    let told = "refused: line 3: the disk overlaps the disk of line 2 by 0.01, a share of 0.01 of their distance at contact; \
                it is the deepest of";
    let radii = |radius: &str| format!("(1 2) r{radius}; (1.99 2) r{radius}; (2.9899 2) r{radius}");
    assert!(of(Reader::new()).starts_with(&format!("{told} 2 such")), "{}", of(Reader::new()));
    let some = Reader::new().with_tolerance(1e-3).unwrap();
    assert!(of(some.clone()).starts_with(&format!("{told} 1 such")));
    assert_eq!(of(Reader::new().with_tolerance(0.011).unwrap()), radii("0.5"));
    let note = " | all radii are shrunk by a share of 0.01 of them";
    assert_eq!(of(Reader::new().with_shrunk_radii()), radii("0.495") + note);
    assert_eq!(of(Reader::new().with_shrunk_radii().with_tolerance(0.011).unwrap()), radii("0.495") + note);
    assert!(of(some.with_shrunk_radii()).starts_with(told));
    let heap = "x,y,radius\n1,2,0.5\n1,2,0.5\n";
    assert!(Reader::new().with_shrunk_radii().read_from(heap.as_bytes()).is_err(), "no radius is left");
    // Overlaps across a periodic side.
    let seam = xyz(
        "Lattice=\"10 0 0 0 5 0 0 0 1\" pbc=\"T F F\" Properties=pos:R:2:radius:R:1",
        "0.375 2 0.5 / 9.5 2 0.5",
    );
    let state = Reader::new().with_shrunk_radii().read_from(seam.as_bytes()).unwrap();
    assert_eq!((state.shrunk(), state.disks()[1].radius()), (0.125, 0.4375));
}

#[test]
fn radii_and_masses_from_the_reader() {
    let reader = Reader::new().with_radius(0.5).unwrap().with_density(4.0).unwrap();
    check(
        &reader,
        &[
            ("1\na comment\nH 1 2 0\n", "kinds 0 H; (1 2) r0.5 m3.141592653589793"),
            ("1\na comment\nH 1 2 0 9 9\n", "kinds 0 H; (1 2) r0.5 m3.141592653589793"),
            ("x y\n1 2\n", "(1 2) r0.5 m3.141592653589793"),
            // A file knows better.
            ("x,y,radius,mass\n1,2,0.25,1\n", "(1 2) r0.25"),
        ],
    );
    assert!(Reader::new().with_radius(0.0).is_err());
    assert!(Reader::new().with_density(f64::NAN).is_err());
    assert!(Reader::new().with_tolerance(-1.0).is_err());
}

#[test]
fn files_that_are_no_text() {
    let refused = |bytes: &[u8]| shown(Reader::new().read_from(bytes));
    let latin = b"1\nProperties=pos:R:2:radius:R:1 Title=\"K\xf6rner\"\n1 2 0.5\n";
    assert!(
        refused(latin).starts_with("refused: line 2: the text must be UTF-8, but is"),
        "{}",
        refused(latin)
    );
    let wide: Vec<u8> = "x,y,radius\n1,2,0.5\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(
        refused(&[&[0xff, 0xfe], wide.as_slice()].concat())
            .starts_with("refused: line 1: the text must be UTF-8")
    );
    assert_eq!(refused(b""), "refused: the file ends after line 0, where a frame should follow");
    assert!(
        refused(b"title = \"a plan\"\n")
            .starts_with("refused: line 1: the file must be extended XYZ, a dump or")
    );
}
