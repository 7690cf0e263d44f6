//! Files of which a part means something else than it seems, or nothing: the reader says so.

use granular_edmd::trajectory::Reader;

use crate::corpus::{check, xyz};

#[test]
fn columns_of_a_plain_xyz_that_nobody_names() {
    let reader = Reader::new().with_radius(0.5).unwrap();
    let named = "kinds 0 H; (1 2) r0.5 | kinds are numbered by name: H 0";
    for (rest, note) in [("", ""), (" 7", " | ignored columns: 5"), (" 7 8 9", " | ignored columns: 5 to 7")]
    {
        check(&reader, &[(&xyz("a comment", &format!("H 1 2 0{rest}")), &format!("{named}{note}"))]);
    }
}
