//! Fingerprints keep their bits; that of a container depends on its geometry, its motions, its rules and its
//! temperatures.

use granular_edmd::Fingerprint;
use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
use granular_edmd::collision::Impulse;
use granular_edmd::collision::{CollisionRule, Elastic, Smooth, from_fn};
use granular_edmd::wall::{AccelerationBounds, BiParabolic, Fixed, Sinusoidal, WallMotion, WallState};

/// A motion without a fingerprint.
struct Nameless;

impl WallMotion for Nameless {
    fn state(&self, _: f64) -> WallState {
        WallState::new(0.0, 0.0)
    }
    fn acceleration(&self, _: f64) -> AccelerationBounds {
        AccelerationBounds::new(f64::INFINITY, 0.0, 0.0)
    }
    fn reach(&self) -> (f64, f64) {
        (0.0, 0.0)
    }
}

fn closed() -> Container {
    Container::closed(8.0, 6.0).unwrap()
}

fn ruled(rule: impl CollisionRule + Send + Sync + 'static) -> Container {
    closed().with_rule(Wall::Lid, rule).unwrap()
}

fn thermal(thermal: Thermal) -> Container {
    closed().with_temperature(Wall::Lid, thermal).unwrap()
}

#[test]
fn whatever_differs_has_another_fingerprint() {
    let moving =
        |wall, amplitude| closed().with_motion(wall, BiParabolic::new(amplitude, 3.0).unwrap()).unwrap();
    let all = [
        closed(),
        Container::closed(8.0, 7.0).unwrap(),
        Container::closed(7.0, 6.0).unwrap(),
        Container::open(8.0).unwrap(),
        closed().with_periodic_sides().unwrap(),
        moving(Wall::Floor, 0.1),
        moving(Wall::Lid, 0.1),
        moving(Wall::Floor, 0.2),
        closed().with_motion(Wall::Floor, Sinusoidal::new(0.1, 3.0).unwrap()).unwrap(),
        ruled(Elastic),
        ruled(Smooth::from_inelasticity(0.1).unwrap()),
        ruled(Smooth::from_inelasticity(0.2).unwrap()),
        thermal(Thermal::new(1.0).unwrap()),
        thermal(Thermal::new(2.0).unwrap()),
        thermal(Thermal::new(2.0).unwrap().with_slip()),
    ];
    let prints: Vec<_> = all.iter().map(|container| container.fingerprint().unwrap()).collect();
    assert!((0..prints.len()).all(|k| !prints[..k].contains(&prints[k])), "{prints:?}");
}

#[test]
fn equal_containers_have_equal_fingerprints_at_all_times() {
    let mut late = closed();
    late.set_time_origin(1e9);
    assert_eq!(late.fingerprint(), closed().fingerprint());
    assert_eq!(closed().with_motion(Wall::Lid, Fixed).unwrap().fingerprint(), closed().fingerprint());
}

#[test]
fn a_part_without_a_fingerprint_leaves_the_container_without_one() {
    assert_eq!(closed().with_motion(Wall::Floor, Nameless).unwrap().fingerprint(), None);
    let closure = from_fn(|contact| Impulse::new(contact.normal_mass() * contact.closing_speed(), 0.0));
    assert_eq!(ruled(closure).fingerprint(), None);
}

/// Checkpoints keep these numbers. If the hash changed, every old checkpoint would seem to belong to other
/// parts.
#[test]
fn fingerprints_keep_their_bits() {
    let part = Fingerprint::of("Frictional").number(0.1).text("sliding");
    assert_eq!(Fingerprint::of("Outer").part(part).to_string(), "fe845dc26511ab39");
}

#[test]
fn texts_are_not_joined() {
    let cut = |a: &str, b: &str| Fingerprint::of("x").text(a).text(b);
    assert_ne!(cut("ab", "c"), cut("a", "bc"));
    assert_ne!(Fingerprint::of("a").number(0.0), Fingerprint::of("a").number(-0.0));
}
