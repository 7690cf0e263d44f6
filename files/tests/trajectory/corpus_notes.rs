//! Files of which a part means something else than it seems, or nothing: the reader says so.

use granular_edmd_files::Reader;

use crate::corpus::{check, dump, xyz};

#[test]
fn columns_of_a_plain_xyz_that_nobody_names() {
    let reader = Reader::new().with_radius(0.5).unwrap();
    let named = "kinds 0 H; (1 2) r0.5 | kinds are numbered by name: H 0";
    for (rest, note) in [("", ""), (" 7", " | ignored: 5"), (" 7 8 9", " | ignored: 5 to 7")] {
        check(&reader, &[(&xyz("a comment", &format!("H 1 2 0{rest}")), &format!("{named}{note}"))]);
    }
}

/// ASE writes what it computed, and this crate the motion of walls.
#[test]
fn keys_without_a_meaning_are_named() {
    let keys =
        "Walls=\"0 0.0 0.1 0.5\" Properties=pos:R:2:radius:R:1 energy=-1.5 pbc=\"F F F\" Step=7 energy=-1.5";
    check(&Reader::new(), &[(&xyz(keys, "1 2 0.5"), "(1 2) r0.5 | ignored: Step, Walls, energy")]);
}

/// ASE writes momenta and, unless it is asked to, no masses.
#[test]
fn momenta_need_masses() {
    let text = xyz("Properties=species:S:1:pos:R:3:momenta:R:3:radius:R:1", "H 1 2 0 3 4 0 0.5");
    let needed = "refused: line 2: a column of masses, or a density (with_density, --density), for the momenta is \
                  missing";
    check(&Reader::new(), &[(&text, needed)]);
    let named = "kinds 0 H; (1 2) r0.5 m3.141592653589793 v(0.954929658551372 1.2732395447351628) | kinds are \
                 numbered by name: H 0";
    check(&Reader::new().with_density(4.0).unwrap(), &[(&text, named)]);
    let dense = "Properties=pos:R:2:momenta:R:2:radius:R:1:density:R:1";
    let moving = "(1 2) r0.5 m3.141592653589793 v(0.954929658551372 1.2732395447351628)";
    check(&Reader::new(), &[(&xyz(dense, "1 2 3 4 0.5 4"), moving)]);
}

/// LIGGGHTS writes the type twice.
#[test]
fn columns_may_repeat_what_they_say() {
    let types = |rows| dump("id type type x y z radius", rows);
    let differ = "must be the same in all columns that give it, but is";
    let twice = |columns: &str, row: &str| format!("{columns}\n{row}\n");
    check(
        &Reader::new(),
        &[
            (&types("1 2 2 1 2 0 0.5"), "0..10p 0..5; (1 2) r0.5 k1 #1"),
            (&types("1 2 1 1 2 0 0.5"), &format!("refused: line 10: type {differ} \"2 and 1\"")),
            // A number of a kind has no rounding.
            (
                &types("1 20000 20001 1 2 0 0.5"),
                &format!("refused: line 10: type {differ} \"20000 and 20001\""),
            ),
            (&twice("x,y,radius,x", "1,2,0.5,1"), "(1 2) r0.5"),
            (&twice("x,y,radius,x", "1,2,0.5,3"), &format!("refused: line 2: x {differ} \"1 and 3\"")),
            (
                &twice("x,y,radius,species,element", "1,2,0.5,Fe,O"),
                &format!("refused: line 2: element {differ} \"Fe and O\""),
            ),
        ],
    );
}

/// ASE's `Z` is the number of an element.
#[test]
fn an_atomic_number_is_no_coordinate() {
    let told = " | ignored: Z";
    let two = "(1 2) r0.5; (3 2) r0.5";
    let atoms = xyz("Properties=Z:I:1:pos:R:3:radius:R:1", "8 1 2 0 0.5 / 26 3 2 0 0.5");
    let apart = xyz("Properties=x:R:1:y:R:1:z:R:1:radius:R:1", "1 2 1 0.5 / 3 2 1 0.5");
    check(&Reader::new(), &[(&atoms, &format!("{two}{told}")), (&apart, two)]);
}

#[test]
fn the_time_of_a_table_is_read() {
    check(
        &Reader::new(),
        &[
            ("time,x,y,radius\n2.5,1,2,0.5\n2.5,3,2,0.5\n", "t 2.5; (1 2) r0.5; (3 2) r0.5"),
            // Units may follow the names.
            ("x [sigma],y [sigma],radius [sigma],time [time]\n1,2,0.5,3\n", "t 3; (1 2) r0.5"),
            ("step,x,y,radius\n7,1,2,0.5\n", "(1 2) r0.5"),
            ("time,x,y,radius\nnoon,1,2,0.5\n", "refused: line 2: time must be a number, but is \"noon\""),
        ],
    );
}

#[test]
fn names_of_rows_as_r_writes_them() {
    let told = " | ignored: (names of rows)";
    check(
        &Reader::new(),
        &[
            (
                "\"x\" \"y\" \"radius\"\n\"1\" 1 2 0.5\n\"2\" 3 2 0.5\n",
                &format!("(1 2) r0.5; (3 2) r0.5{told}"),
            ),
            ("\"species\" \"x\" \"y\" \"radius\"\n\"1\" \"3\" 1 2 0.5\n", &format!("(1 2) r0.5 k3{told}")),
            // A cell too many may be any of them.
            (
                "x,y,radius\n1,2,0.5,9\n",
                "refused: line 2: the number of values must be 3, one for each column, but is \"4\"",
            ),
        ],
    );
}

#[test]
fn out_of_the_plane_is_no_number_either() {
    let lie = "must be the same for all disks, which lie in a plane, but is";
    let stay = "must be 0, for disks move in a plane, but is";
    check(
        &Reader::new(),
        &[
            ("x,y,z,radius\n1,2,nan,0.5\n", &format!("refused: line 2: z {lie} \"NaN\"")),
            ("x,y,z,radius\n1,2,inf,0.5\n", &format!("refused: line 2: z {lie} \"inf\"")),
            ("x,y,z,radius\n1,2,0,0.5\n3,2,nan,0.5\n", &format!("refused: line 3: z {lie} \"NaN\"")),
            ("x,y,vz,radius\n1,2,nan,0.5\n", &format!("refused: line 2: vz {stay} \"NaN\"")),
        ],
    );
}

#[test]
fn unwrapped_positions_need_a_box() {
    let told = "(1 2) r0.5 | unwrapped positions are ignored, since the file has no box";
    check(
        &Reader::new(),
        &[("x,y,xu,radius\n1,2,21,0.5\n", told), ("xu,yu,radius\n1,2,0.5\n", "(1 2) r0.5")],
    );
}

/// A disk that is wider than a period overlaps itself.
#[test]
fn disks_fit_into_a_period() {
    let keys = |pbc| format!("Lattice=\"2 0 0 0 3 0 0 0 1\" pbc=\"{pbc}\" Properties=pos:R:2:radius:R:1");
    let told = |most: &str| {
        format!(
            "refused: line 3: the diameter of the disk must be at most {most}, a period of the box, but is \"3.5\""
        )
    };
    check(
        &Reader::new(),
        &[
            (&xyz(&keys("T F F"), "1 2 1"), "0..2p 0..3; (1 2) r1"),
            (&xyz(&keys("T F F"), "1 2 1.75"), &told("2")),
            (&xyz(&keys("F T F"), "1 2 1.75"), &told("3")),
            (&xyz(&keys("F F F"), "1 2 1.75"), "0..2 0..3; (1 2) r1.75"),
        ],
    );
}
