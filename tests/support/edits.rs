//! Random changes of a text.

use proptest::prelude::*;

/// A change of a text.
#[derive(Debug, Clone)]
pub(crate) enum Edit {
    Remove(usize, usize),
    Insert(usize, &'static str),
    Replace(usize, char),
}

/// Returns removals, replacements, and words that readers must not stumble over.
pub(crate) fn edit() -> impl Strategy<Value = Edit> {
    let words = prop::sample::select(vec![
        "nan",
        "inf",
        "-inf",
        "-",
        "0",
        "9",
        "e308",
        "1e-320",
        ".",
        "\n",
        "=",
        "[",
        "]",
        "{",
        "}",
        "\"",
        "#",
        "9223372036854775807",
        "18446744073709551616",
        "[[sweep]]\n",
        "[ramp]\n",
        "disks = 1\n",
        "Time=nan ",
        "4294967297",
        ",",
        "\u{feff}",
        "\u{0}",
        "é",
    ]);
    prop_oneof![
        (any::<usize>(), 1..30usize).prop_map(|(at, length)| Edit::Remove(at, length)),
        (any::<usize>(), words).prop_map(|(at, word)| Edit::Insert(at, word)),
        (any::<usize>(), any::<char>()).prop_map(|(at, letter)| Edit::Replace(at, letter)),
    ]
}

/// Returns the text with these changes, one after the other.
pub(crate) fn edited(text: &str, edits: &[Edit]) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for edit in edits {
        let (at, count) = match edit {
            Edit::Remove(at, count) => (*at, *count),
            Edit::Insert(at, _) => (*at, 0),
            Edit::Replace(at, _) => (*at, 1),
        };
        let start = at % (letters.len() + 1);
        let new: Vec<char> = match edit {
            Edit::Remove(..) => Vec::new(),
            Edit::Insert(_, word) => word.chars().collect(),
            Edit::Replace(_, letter) => vec![*letter],
        };
        let end = (start + count).min(letters.len());
        letters.splice(start..end, new);
    }
    letters.into_iter().collect()
}
