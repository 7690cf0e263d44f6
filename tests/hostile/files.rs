//! Files of any contents: an error or a value, never a panic, and never a file read as what it is not.

use granular_edmd::simulation::{Checkpoint, CheckpointError};
use proptest::prelude::*;

use crate::specimens::{CONTENTS_AT, Scratch, VERSION_AT, checkpoint, sealed};
use support::cases::config;

#[test]
fn a_sealed_file_is_resealed_as_the_library_does() {
    let bytes = checkpoint().to_bytes().unwrap();
    assert_eq!(sealed(&bytes, &bytes[CONTENTS_AT..]), bytes);
}

/// Files with one bit flipped, each `stride`-th one, and all beginnings.
fn damaged(bytes: &[u8], stride: usize) -> impl Iterator<Item = Vec<u8>> {
    let flipped = (0..8 * bytes.len()).step_by(stride).map(|bit| {
        let mut bytes = bytes.to_vec();
        bytes[bit / 8] ^= 1 << (bit % 8);
        bytes
    });
    flipped.chain((0..bytes.len()).map(|length| bytes[..length].to_vec()))
}

#[test]
fn each_flipped_bit_and_each_cut_of_a_checkpoint_is_noticed() {
    let bytes = checkpoint().to_bytes().unwrap();
    for (case, bytes) in damaged(&bytes, 1).enumerate() {
        assert!(Checkpoint::from_bytes(&bytes).is_err(), "case {case}");
    }
}

#[test]
fn another_version_is_named() {
    let mut bytes = checkpoint().to_bytes().unwrap();
    for version in [0, 77, u32::MAX] {
        bytes[VERSION_AT..VERSION_AT + 4].copy_from_slice(&version.to_le_bytes());
        let error = Checkpoint::from_bytes(&bytes).unwrap_err();
        assert!(matches!(error, CheckpointError::Version { found, .. } if found == version), "{error}");
        assert!(error.to_string().contains(&version.to_string()), "{error}");
    }
}

#[test]
fn files_that_cannot_be_read_are_errors() {
    let scratch = Scratch::new("unreadable");
    for path in [scratch.0.clone(), scratch.0.join("none"), "/dev/null".into()] {
        let error = Checkpoint::read(&path).unwrap_err();
        assert!(matches!(error, CheckpointError::Io { .. } | CheckpointError::File { .. }), "{error}");
    }
    let error = checkpoint().write(scratch.0.join("none/file")).unwrap_err();
    assert!(matches!(error, CheckpointError::Io { .. }), "{error}");
}

/// A checkpoint is bytes in any format, so nothing gets past its version and checksum.
#[test]
fn a_checkpoint_with_a_byte_too_many_is_refused() {
    let mut state = serde_json::to_value(checkpoint()).unwrap();
    state.as_array_mut().unwrap().push(serde_json::json!(1));
    let error = serde_json::from_value::<Checkpoint>(state).unwrap_err();
    assert!(error.to_string().contains("damaged"), "{error}");
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn any_bytes_are_no_checkpoint(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(Checkpoint::from_bytes(&bytes).is_err());
    }

    /// Any bytes behind a seal that is whole are decoded or refused.
    #[test]
    fn any_sealed_bytes_are_decoded_or_refused(contents in prop::collection::vec(any::<u8>(), 0..400)) {
        let header = checkpoint().to_bytes().unwrap();
        let _ = Checkpoint::from_bytes(&sealed(&header, &contents));
    }
}
