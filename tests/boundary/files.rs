//! Walls in files: every motion of the crate goes round.
#![cfg(feature = "serde")]

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::wall::{
    BiParabolic, Combined, Fixed, KnownMotion, Piston, Sawtooth, Sinusoidal, Tabulated, Triangular,
    WallMotion,
};

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
    fn moving<M: WallMotion + Clone + Send + Sync + 'static>(name: &str, motion: M) -> String {
        goes_round(&closed().with_motion(Wall::Floor, motion.clone()).unwrap(), name);
        goes_round(
            &closed()
                .shaken_vertically(Combined::new(motion.clone()).scaled(0.5).unwrap())
                .unwrap_or_else(|_| closed()),
            name,
        );
        let late = Combined::new(motion).starting_at(2.5).unwrap();
        goes_round(&closed().with_motion(Wall::Lid, late).unwrap(), name);
        name.to_owned()
    }
    let sine = || Sinusoidal::new(0.1, 3.0).unwrap();
    let gate = || Tabulated::new([(0.0, 0.0), (1.0, 0.3), (4.0, 0.1)]).unwrap();
    let tried = [
        moving("BiParabolic", BiParabolic::new(0.1, 3.0).unwrap()),
        moving("Combined", Combined::new(gate()).plus(sine()).unwrap().delayed_until(2.0).unwrap()),
        moving("Fixed", Fixed),
        moving("KnownMotion", KnownMotion::from(sine())),
        moving("Sawtooth", Sawtooth::new(0.1, 3.0).unwrap()),
        moving("Sinusoidal", Sinusoidal::new(0.1, 3.0).unwrap()),
        moving("Tabulated", gate()),
        moving("Triangular", Triangular::new(0.1, 3.0).unwrap()),
    ];
    // A motion that is public and not tried here is one that someone added.
    let source = include_str!("../../src/wall.rs");
    let ours = source.lines().filter_map(|line| line.strip_prefix("pub use ")?.strip_suffix(';'));
    let names = ours.filter_map(|path| path.rsplit("::").next()).flat_map(|names| names.split(", "));
    let names =
        names.map(|name| name.trim_matches(['{', '}'])).filter(|name| name.starts_with(char::is_uppercase));
    let mut types: Vec<_> =
        names.filter(|name| !["Approach", "FirstTouch", "Piston"].contains(name)).collect();
    types.sort_unstable();
    // A piston is no motion that others could hold.
    let lid = Piston::new(3.0, [-0.5, 2.0]).unwrap().with_force(1.0).unwrap().with_spring(2.0, 0.5).unwrap();
    let piston = closed().with_piston(Wall::Lid, lid.with_start(0.25, -1.0).unwrap()).unwrap();
    goes_round(&piston, "Piston");
    let text = serde_json::to_string(&piston).unwrap();
    let motion = text.split_once("\"stroke\":").unwrap().1.split_once('}').unwrap().0;
    let wrapped = format!("{{\"stroke\":{motion}}}}}");
    let error = serde_json::from_str::<KnownMotion>(&wrapped).unwrap_err().to_string();
    assert!(error.contains("only a wall of a container can be a piston"), "{error}");
    assert_eq!(types, tried);
    goes_round(&closed().shaken_sideways(Sinusoidal::new(0.1, 3.0).unwrap()).unwrap(), "shaken");
}
