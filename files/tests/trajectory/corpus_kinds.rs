//! Kinds by numbers and names, which do not depend on the order of the disks.

use granular_edmd_files::Reader;

use crate::corpus::{check, shown, xyz};

#[test]
fn whole_numbers_may_be_written_as_floats() {
    let table = |name: &str, kinds: [&str; 2]| {
        format!("x,y,radius,{name}\n1,1,.5,{1}\n3,1,.5,{0}\n5,1,.5,{1}\n", kinds[0], kinds[1])
    };
    let expected = "(1 1) r0.5 k2; (3 1) r0.5 k1; (5 1) r0.5 k2";
    for name in ["kind", "type", "species"] {
        for kinds in [["1", "2"], ["1.0", "2.0"], ["1.", "2.00"], ["1.000e+00", "2.000e+00"], ["1", "2.0"]] {
            check(&Reader::new(), &[(&table(name, kinds), expected)]);
        }
    }
    check(
        &Reader::new(),
        &[
            (
                "x,y,radius,kind\n1,1,.5,1.5\n",
                "refused: line 2: kind must be a whole number that fits into u16, but is \"1.5\"",
            ),
            (
                "x,y,radius,id\n1,1,.5,-1.0\n",
                "refused: line 2: id must be a whole number that fits into u64, but is \"-1.0\"",
            ),
            (
                "x,y,radius,id\n1,1,.5,1e300\n",
                "refused: line 2: id must be a whole number that fits into u64, but is \"1e300\"",
            ),
        ],
    );
}

/// Frames with the same names have the same kinds, whatever the order of the disks.
#[test]
fn names_are_numbered_in_their_own_order() {
    let properties = "Properties=id:I:1:species:S:1:pos:R:2:radius:R:1";
    let frames =
        xyz(properties, "1 O 1 1 0.5 / 2 Fe 3 1 0.5") + &xyz(properties, "2 Fe 3 1 0.5 / 1 O 1 1 0.5");
    let states: Result<Vec<_>, _> = Reader::new().frames(frames.as_bytes()).unwrap().collect();
    let said = "kinds are numbered by name: Fe 0, O 1";
    let [first, second] = ["(1 1) r0.5 k1 #1", "(3 1) r0.5 #2"];
    let shown: Vec<String> = states.unwrap().into_iter().map(|state| shown(Ok(state))).collect();
    let expected = |disks: &str| format!("kinds 0 Fe, 1 O; {disks} | {said}");
    assert_eq!(shown[0], expected(&format!("{first}; {second}")));
    assert_eq!(shown[1], expected(&format!("{second}; {first}")));
}

#[test]
fn many_names_make_a_short_note() {
    let rows: Vec<String> = (0..30).map(|number| format!("{number:02}x {number} 1 0.5")).collect();
    let text = xyz("Properties=species:S:1:pos:R:2:radius:R:1", &rows.join("/"));
    let state = Reader::new().read_from(text.as_bytes()).unwrap();
    let notes =
        ["kinds are numbered by name: 00x 0, 01x 1, 02x 2, 03x 3, 04x 4, 05x 5, 06x 6, 07x 7, and 22 others"];
    assert_eq!(state.notes(), notes);
    assert_eq!(state.kind_names().len(), 30);
}
