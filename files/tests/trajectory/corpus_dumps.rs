//! Small dumps of LAMMPS and LIGGGHTS.

use granular_edmd_files::Reader;

use crate::corpus::{check, dump};

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
            "refused: line 10: x must be the same in all columns that give it, but is \"21 and 11\"",
        ),
        (
            "id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius",
            "1 1 1 1 2 0 0 0 0 3 4 0 9 9 9 0 0 5 0.5",
            "(1 2) r0.5 v(3 4) w5 #1 | ignored: fx, fy, fz",
        ),
        (
            "id type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius",
            "1 1 1 2 0 0 0 0 3 4 0 9 9 9 0 0 5 0.5",
            "(1 2) r0.5 v(3 4) w5 #1 | ignored: fx, fy, fz",
        ),
        ("id x y radius density", "1 1 2 0.5 6", "(1 2) r0.5 m3.141592653589793 #1"),
        ("id x y radius c_one[1] v_two", "1 1 2 0.5 9 9", "(1 2) r0.5 #1 | ignored: c_one[1], v_two"),
        ("id type element x y radius", "1 2 Fe 1 2 0.5", "(1 2) r0.5 k1 #1 | ignored: element"),
        (
            "id element x y radius",
            "1 Fe 1 2 0.5",
            "kinds 0 Fe; (1 2) r0.5 #1 | kinds are numbered by name: Fe 0",
        ),
        // Rows stay in the order of the file.
        ("id x y radius", "2 1 2 0.5 / 1 3 2 0.5", "(1 2) r0.5 #2; (3 2) r0.5 #1"),
        // Disks outside of periodic sides are wrapped, others are not.
        (
            "id x y radius",
            "1 11 2 0.5 / 2 -7 2 0.5",
            "(1 2) r0.5 i(1 0) #1; (3 2) r0.5 i(-1 0) #2 | disks outside of periodic sides, wrapped: 2",
        ),
        ("id x y radius", "1 1 6 0.5", "refused: line 10: the disk at (1.0, 6.0) is outside the box"),
        ("id type x y radius", "1 0 1 2 0.5", "refused: line 10: type must be from 1 to 65536, but is \"0\""),
        (
            "id type x y",
            "1 1 1 2",
            "refused: line 9: the column `radius`, or one radius for all (with_radius, --radius), is missing",
        ),
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
        (
            "abc origin pp pp pp\n10 0 0 0\n0 5 0 0\n0 0 1 -0.5",
            "refused: line 7: the box must be three lines of 2 or 3 numbers, but is \"0 5 0 0\"",
        ),
        (
            "\n0 10\n0 5\n-1 1",
            "0..10 0..5; (1 2) r0.5 | no side is periodic, since the dump does not say which are",
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
                "0..10p 0..5; (1 2) r0.5 | the last line has no line break: its last number may be cut short",
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
