//! Data files of LAMMPS by their sections, styles and boxes, with the values that they mean, or the refusal.

use std::fs;

use granular_edmd_files::Reader;

use crate::corpus::check;
use crate::corpus_files::path;

/// A data file with these lines in its header, with these sections.
fn data(header: &str, sections: &str) -> String {
    format!("title\n\n{header}\n\n{sections}")
}

const BOX: &str = "2 atoms\n0 8 xlo xhi\n0 6 ylo yhi\n-0.5 0.5 zlo zhi";
const ATOMS: &str = "\n\n1 1 1 6 2 3 0\n2 2 0.5 6 5 3 0\n";

/// Adds what is said where a file does not name the style of its atoms, or its periodic sides.
fn guessed((text, said): (String, String)) -> (String, String) {
    let style = " | the atoms are read as those of the style `sphere` (id type diameter density x y z), since the file does \
                 not name it; `Atoms # full` would name another";
    let style = if text.contains("sphere") { "" } else { style };
    if said.starts_with("refused") {
        return (text, said);
    }
    let sides = if said.contains("8p ") {
        "the box is periodic in x only, since the file does not say where it is, and images along it are not 0"
    } else {
        "no side is periodic, since the file does not say which are, and all images are 0"
    };
    let notes = said.find(" | ").unwrap_or(said.len());
    let said = format!("{} | {sides}{style}{}", &said[..notes], &said[notes..]);
    (text, said)
}

#[test]
fn data_of_lammps_by_sections_and_styles() {
    let mass = "m3.141592653589793";
    let small = "m0.39269908169872414";
    let two = format!("0..8 0..6; (2 3) r0.5 {mass} #1; (5 3) r0.25 {small} k1 #2");
    let plain = |name: &str| data(BOX, &format!("Atoms{name}{ATOMS}"));
    let with = |lines: &str| data(&format!("{BOX}\n{lines}"), &format!("Atoms{ATOMS}"));
    let after = |section: &str| format!("{}\n{section}", plain(""));
    let style = |line, found: &str| {
        format!("refused: line {line}: the style of atoms must be `sphere`, but is {found:?}")
    };
    let torn = " | the last line has no line break: its last number may be cut short";
    let cases: Vec<(String, String)> = vec![
        (plain(""), two.clone()),
        (plain(" # sphere"), two.clone()),
        (plain("   #sphere  "), two.clone()),
        (plain(" # sphere id type diameter density x y z"), two.clone()),
        (plain(" # line"), style(8, "line")),
        (plain(" # body"), style(8, "body")),
        (
            plain(" # full"),
            "refused: line 8: the column `radius`, or one radius for all (with_radius, --radius), is missing"
                .into(),
        ),
        (plain(" # hybrid sphere charge"), style(8, "hybrid sphere charge")),
        (data(BOX, "Atoms # hybrid sphere\n\n1 1 2 3 0 1 6 0 0 0\n2 2 5 3 0 0.5 6 0 0 0\n"), two.clone()),
        (data(BOX, "Atoms # hybrid\n\n1 1 2 3 0 1 6\n2 2 5 3 0 0.5 6\n"), two.clone()),
        (
            data(BOX, "Atoms # sphere x y z id type density diameter\n\n2 3 0 1 1 6 1\n5 3 0 2 2 6 0.5\n"),
            two.clone(),
        ),
        // Other styles have 7 columns, too.
        (with("2 bodies"), style(7, "one with `bodies`")),
        (with("2 ellipsoids"), style(7, "one with `ellipsoids`")),
        (with("1 bonds"), style(7, "one with `bonds`")),
        (with("0 bodies\n0 bonds"), two.clone()),
        (after("Bodies\n\n1 1 12\n4\n"), style(13, "one with `Bodies`")),
        (after("Ellipsoids\n\n1 1 1 1 1 0 0 0\n"), style(13, "one with `Ellipsoids`")),
        (after("Masses\n\n1 1.0\n2 1.0\n"), style(13, "one with `Masses`")),
        (after("Pair Coeffs # gran\n\n1\n2\n"), two.clone()),
        // Boxes.
        (with("0 0 0 xy xz yz"), two.clone()),
        (with("1e-13 0 -1e-15 xy xz yz"), two.clone()),
        (
            with("0.5 0 0 xy xz yz"),
            "refused: line 7: the box must be a rectangle, but is \"0.5 0 0 xy xz yz\"".into(),
        ),
        (
            data("2 atoms\n8 0 0 avec\n0 6 0 bvec\n0 0 1 cvec", &format!("Atoms{ATOMS}")),
            "refused: line 4: the box must be `xlo xhi` and `ylo yhi`, the sides of a rectangle, but is \"the vector `avec`\"".into(),
        ),
        // Labels, comments, line breaks.
        (
            data(
                &format!("{BOX}\n2 atom types"),
                "Atom Type Labels\n\n1 big\n2 small # the others\n\nAtoms # sphere\n\n1 big 1 6 2 3 0\n2 small 0.5 6 5 3 0\n",
            ),
            two.replace("(2 3)", "kinds 0 big, 1 small; (2 3)")
                + " | kinds are numbered by name: big 0, small 1",
        ),
        (
            data(BOX, "Atoms\n# id type\n\n1 1 1 6 2 3 0 # a big one\n  # a small one\n2 2 0.5 6 5 3 0\n"),
            two.clone(),
        ),
        (plain("").trim_end().to_owned(), format!("{two}{torn}")),
        (plain("").replace('\n', "\r\n").replace(' ', "\t"), two.clone()),
        // The plane.
        (plain("").replace("3 0\n", "3 0.25\n"), two.clone()),
        (plain("").replace("2 3 0\n", "2 3 1e-17\n"), two.clone()),
        (
            plain("").replace("2 3 0\n", "2 3 0.25\n"),
            "refused: line 11: z must be the same for all disks, which lie in a plane, but is \"0\"".into(),
        ),
        (
            after("Velocities\n\n1 0 0 0 0 0 2\n2 1 0 0 0 1 0\n"),
            "refused: line 11: wy must be 0, for disks move in a plane, but is \"1\"".into(),
        ),
        (
            after("Velocities\n\n2 1 0 0 0 0 2\n1 0 -3 0 0 0 0\n"),
            two.replace(&format!("{mass} #1"), &format!("{mass} v(0 -3) #1"))
                .replace(&format!("{small} k1"), &format!("{small} v(1 0) w2 k1")),
        ),
        // Only disks of a periodic box have passed its sides.
        (
            plain("").replace("2 3 0\n", "2 3 0 -1 0 0\n").replace("5 3 0\n", "13.5 3 0 2 0 0\n"),
            format!(
                "0..8p 0..6; (2 3) r0.5 {mass} i(-1 0) #1; (5.5 3) r0.25 {small} k1 i(3 0) #2 | disks outside of periodic \
                 sides, wrapped: 1"
            ),
        ),
        (
            plain("").replace("5 3 0\n", "13.5 3 0\n"),
            "refused: line 11: the disk at (13.5, 3.0) is outside the box".into(),
        ),
    ];
    let cases: Vec<(String, String)> = cases.into_iter().map(guessed).collect();
    let cases: Vec<(&str, &str)> = cases.iter().map(|(text, said)| (text.as_str(), said.as_str())).collect();
    check(&Reader::new(), &cases);
}

/// Cut at any byte, a file is read whole, with a note if its last number may be cut, or is refused.
#[test]
fn cut_data_is_read_or_refused() {
    let text = fs::read_to_string(path("labels.data")).unwrap();
    for cut in 0..text.len() {
        if let Ok(state) = Reader::new().read_from(&text.as_bytes()[..cut]) {
            assert_eq!(state.disks().len(), 25, "{cut}");
            let is_said = state.notes().iter().any(|note| note.contains("no line break"));
            assert!(
                is_said || text[..cut].ends_with('\n') || cut < text.find("Velocities").unwrap(),
                "{cut}"
            );
        }
    }
}
