//! Walls in files: every motion of the crate goes round.
#![cfg(feature = "serde")]

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, StartingAt, Triangular, WallMotion};

fn closed() -> Container {
    Container::closed(8.0, 6.0).unwrap()
}

fn goes_round(container: &Container, name: &str) {
    let text = serde_json::to_string(container).unwrap_or_else(|error| panic!("{name}: {error}"));
    let back: Container = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(serde_json::to_string(&back).unwrap(), text, "{name}");
    assert_eq!(back.fingerprint().unwrap(), container.fingerprint().unwrap(), "{name}");
}

/// The public motions, as the source lists them.
#[test]
fn every_motion_goes_round() {
    fn moving<M: WallMotion + Copy + Send + Sync + 'static>(name: &str, motion: M) -> String {
        goes_round(&closed().with_motion(Wall::Floor, motion).unwrap(), name);
        let late = StartingAt::new(motion, 2.5).unwrap();
        goes_round(&closed().with_motion(Wall::Lid, late).unwrap(), name);
        name.to_owned()
    }
    let tried = [
        moving("BiParabolic", BiParabolic::new(0.1, 3.0).unwrap()),
        moving("Fixed", Fixed),
        moving("Sawtooth", Sawtooth::new(0.1, 3.0).unwrap()),
        moving("Sinusoidal", Sinusoidal::new(0.1, 3.0).unwrap()),
        moving("StartingAt", Sinusoidal::new(0.1, 3.0).unwrap()),
        moving("Triangular", Triangular::new(0.1, 3.0).unwrap()),
    ];
    // A motion that is public and not tried here is one that someone added.
    let source = include_str!("../../src/wall.rs");
    let ours = source.lines().filter_map(|line| line.strip_prefix("pub use ")?.strip_suffix(';'));
    let types = ours.filter_map(|path| path.rsplit("::").next()).filter(|name| !name.contains('{'));
    let types = types.filter(|name| name.starts_with(char::is_uppercase) && *name != "Violation");
    assert_eq!(types.collect::<Vec<_>>(), tried);
    goes_round(&closed().shaken_sideways(Sinusoidal::new(0.1, 3.0).unwrap()).unwrap(), "shaken");
}
