//! Walls and boundaries of a user keep their contracts.

use downstream::drum::Drum;
use downstream::two_sines::TwoSines;
use downstream::viscoelastic::Viscoelastic;
use granular_edmd::boundary::{self, Boundary, Container, Wall};
use granular_edmd::wall::{self, WallMotion};

const MOTION: TwoSines = TwoSines { amplitudes: [0.2, 0.11], frequencies: [3.0, 7.3] };

#[test]
fn a_motion_keeps_its_contract() {
    for from in [-30.0, 0.0, 1e4] {
        assert_eq!(wall::laws::check(&MOTION, from, from + 5.0), Ok(()));
    }
}

#[test]
fn a_drum_keeps_its_contract() {
    for (radius, speed) in [(0.5, 1.0), (3.0, 1e-3), (7.0, 1e4)] {
        let drum = Drum::new(8.0).unwrap().turning(0.3);
        assert_eq!(
            boundary::laws::check(
                &mut drum.with_rule(Viscoelastic::new(0.1, 0.0).unwrap()),
                radius,
                speed,
                1
            ),
            Ok(())
        );
    }
}

#[test]
fn a_container_with_a_motion_of_ones_own_keeps_its_contract() {
    let mut container = Container::closed(9.0, 7.0).unwrap().with_motion(Wall::Floor, MOTION).unwrap();
    assert_eq!(boundary::laws::check(&mut container, 0.5, 1.0, 2), Ok(()));
}

#[test]
fn fingerprints_tell_who_is_who() {
    let drum = Drum::new(8.0).unwrap();
    let print = |drum: &Drum| drum.fingerprint().unwrap();
    assert_eq!(print(&drum), print(&Drum::new(8.0).unwrap()));
    assert_ne!(print(&drum), print(&Drum::new(8.5).unwrap()));
    assert_ne!(print(&drum), print(&drum.turning(0.1)));
    assert_ne!(print(&drum), print(&drum.with_rule(Viscoelastic::new(0.1, 0.0).unwrap())));
    assert_ne!(MOTION.fingerprint(), TwoSines { amplitudes: [0.2, 0.1], ..MOTION }.fingerprint());
}
