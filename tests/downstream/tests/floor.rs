//! A floor with a user's motion: no touch is missed, and none comes early.

use downstream::lazy_heap::LazyHeap;
use downstream::two_sines::TwoSines;
use downstream::viscoelastic::Viscoelastic;
use granular_edmd::boundary::{Container, Wall};
use granular_edmd::observable::{Collision, SampleTimes, Snapshot, on_collision, on_sample};
use granular_edmd::wall::{Approach, WallMotion, first_touch};
use granular_edmd::{Simulation, initial};

const MOTION: TwoSines = TwoSines { amplitudes: [0.2, 0.11], frequencies: [3.0, 7.3] };

#[test]
fn no_disk_is_ever_below_the_floor() {
    let boundary = Container::closed(15.0, 40.0).unwrap().with_motion(Wall::Floor, MOTION).unwrap();
    let disks = initial::lattice(&boundary, 80, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3).unwrap();
    let mut simulation = Simulation::builder(Viscoelastic::new(0.05, 0.2).unwrap(), boundary)
        .disks(disks)
        .gravity(0.5)
        .scheduler(LazyHeap::default())
        .build()
        .unwrap();
    let depth = |time: f64, height: f64| MOTION.state(time).displacement + 0.5 - height;
    let (mut deepest, mut at_touch, mut touches) = (f64::NEG_INFINITY, 0.0_f64, 0);
    let samples = on_sample(SampleTimes::every(0.01).unwrap(), |s: &Snapshot<'_>| {
        for disk in s.disks() {
            deepest = deepest.max(depth(s.time(), disk.position().y));
        }
    });
    let collisions = on_collision(|c: &Collision| {
        if c.partner == granular_edmd::observable::Partner::Wall(0) {
            touches += 1;
            at_touch = at_touch.max(depth(c.time, c.position.y).abs());
        }
    });
    simulation.run_until(150.0, &mut (samples, collisions)).unwrap();
    assert!(touches > 1000, "{touches}");
    assert!(at_touch < 1e-10, "{at_touch}");
    assert!(deepest < 1e-10, "{deepest}");
}

#[test]
fn the_search_is_exact_with_nothing_but_global_bounds() {
    let mut touches = 0;
    for case in 0..2000 {
        let height = 0.35 + 0.001 * f64::from(case % 50);
        let approach = Approach::new(0.05 * f64::from(case), height, 0.7 - 0.03 * f64::from(case % 47), -1.0);
        let gap = |wait: f64| {
            let surface = height + (0.7 - 0.03 * f64::from(case % 47) - 0.5 * wait) * wait;
            surface - MOTION.state(0.05 * f64::from(case) + wait).displacement
        };
        let touch = first_touch(&MOTION, &approach, 1000.0).touch().unwrap() - 0.05 * f64::from(case);
        assert!(gap(touch).abs() < 1e-11, "case {case}: {}", gap(touch));
        assert!((0..2000).all(|k| gap(touch * f64::from(k) / 2000.0) > -1e-12), "case {case}");
        touches += 1;
    }
    assert_eq!(touches, 2000);
}
