//! Disks: what their constructors accept, and that a disk of a run can be read back.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;

fn disk() -> Disk {
    Disk::new(DVec2::new(1.0, -2.0), 0.5).unwrap()
}

/// An angle grows without bound in a long run, and nothing is computed from it.
#[test]
fn any_finite_angle_is_accepted() {
    for angle in [0.0, -1e61, 1e300, f64::MAX, f64::MIN_POSITIVE] {
        assert_eq!(disk().with_angle(angle).unwrap().angle(), angle);
    }
    let error = disk().with_angle(f64::INFINITY).unwrap_err();
    assert_eq!(error.to_string(), "angle must be finite, but is inf");
}

#[test]
fn a_disk_is_homogeneous_unless_said_otherwise() {
    assert_eq!(disk().inertia_factor(), Disk::HOMOGENEOUS_INERTIA_FACTOR);
    assert_eq!(disk().moment_of_inertia(), 0.5 * 0.5 * 0.5);
}

#[cfg(feature = "serde")]
#[test]
fn a_disk_that_turned_for_long_returns_from_a_file() {
    let turned = disk().with_angle(-3.5e77).and_then(|disk| disk.with_angular_velocity(-1e60)).unwrap();
    let text = serde_json::to_string(&turned).unwrap();
    assert_eq!(serde_json::from_str::<Disk>(&text).unwrap(), turned);
    let faster = text.replace("-1e60", "-1e61").replace("-1e+60", "-1e+61");
    let error = serde_json::from_str::<Disk>(&faster).unwrap_err().to_string();
    assert!(
        error.starts_with("angular velocity must be finite and at most 1e60 in magnitude, but is -1"),
        "{error}"
    );
}
