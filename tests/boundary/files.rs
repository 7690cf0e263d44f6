//! Walls in files: every motion and every rule of the crate goes round, in whatever it stands.
#![cfg(feature = "serde")]

use granular_edmd::Kind;
use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{
    CollisionRule, ContactDuration, Elastic, ElasticBelow, Frictional, LeastRebound, Rough, RulesByKind,
    Smooth, SpeedDependent,
};
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

/// The rules alone, in a remedy, in two, and in a table by kinds.
#[test]
fn every_rule_goes_round() {
    fn ruled<R: CollisionRule + Clone + Send + Sync + 'static>(name: &str, rule: R) {
        let on_floor = |rule: &dyn Fn(Container) -> Container| goes_round(&rule(closed()), name);
        let remedy = || ContactDuration::new(rule.clone(), 1e-3).unwrap();
        let table = || RulesByKind::new(rule.clone()).with(Kind::new(1), Kind::WALL, rule.clone());
        on_floor(&|container| container.with_rule(Wall::Floor, rule.clone()).unwrap());
        on_floor(&|container| container.with_rule(Wall::Floor, remedy()).unwrap());
        on_floor(&|container| container.with_rule(Wall::Floor, table()).unwrap());
        let nested = || LeastRebound::new(remedy(), 0.1).unwrap();
        on_floor(&|container| container.with_rule(Wall::Floor, nested()).unwrap());
        let around = || ElasticBelow::new(table(), 0.1).unwrap();
        on_floor(&|container| container.with_rule(Wall::Floor, around()).unwrap());
    }
    ruled("Elastic", Elastic);
    ruled("Smooth", Smooth::from_inelasticity(0.1).unwrap());
    ruled("Rough", Rough::from_inelasticity(0.1, 0.2).unwrap());
    ruled("Frictional", Frictional::from_inelasticity(0.1, 0.1, 0.3).unwrap());
    ruled("SpeedDependent", SpeedDependent::from_restitution(0.7, 1.0).unwrap());
}
