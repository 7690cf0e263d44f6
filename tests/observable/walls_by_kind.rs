//! Measures that divide by areas, among walls for some kinds of disks only.

use granular_edmd::boundary::{Container, Part, Region};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Arrivals, CollisionCounts, CollisionHistograms, EnergyChange, Fields, Grid, HeightProfile, Observer,
    OfKind, SampleTimes, Sampled, Stress, WallStress,
};
use granular_edmd::{Disk, Kind, ParameterError, Simulation};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const KIND: Kind = Kind::new(1);

/// Runs one disk of the kind in a box with a part for this kind.
fn run(part: Part, observer: &mut impl Observer) -> Outcome {
    let vessel = Container::closed(12.0, 9.0)?.with_part("part", part.only_for([KIND]))?;
    let disk = Disk::new(DVec2::new(1.0, 1.0), 0.5)?.with_kind(KIND).with_velocity(DVec2::Y)?;
    Simulation::builder(Elastic, vessel).disks([disk]).build()?.run_until(2.5, observer)?;
    Ok(())
}

fn corners() -> [DVec2; 4] {
    [(3.0, 2.0), (9.0, 2.0), (9.0, 7.0), (3.0, 7.0)].map(DVec2::from)
}

#[test]
fn areas_that_depend_on_the_kind_are_refused_by_name() -> Outcome {
    let times = SampleTimes::every(1.0)?;
    let profile = || HeightProfile::new(0.0, 9.0, 3);
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(12.0, 9.0)), 2, 2)?;
    let refusals = |part: &Part| -> Result<_, Box<dyn std::error::Error>> {
        Ok([
            run(part.clone(), &mut Stress::new(times)),
            run(part.clone(), &mut Sampled::new(profile()?, times)),
            run(part.clone(), &mut Sampled::new(Fields::new(grid), times)),
            run(part.clone(), &mut OfKind::new(KIND, Sampled::new(profile()?, times))),
        ])
    };
    for outcome in refusals(&Part::block(corners())?)? {
        let error = outcome.expect_err("an area that is known");
        let text = error.source().ok_or("an observer's error has a cause")?.to_string();
        assert!(text.contains("free area") && text.contains("stop all kinds of disks"), "{text}");
    }
    for outcome in refusals(&Part::polyline(corners())?)? {
        outcome?;
    }
    Ok(())
}

/// Beside the block, as the refusal advises.
#[test]
fn a_region_to_which_no_wall_comes_is_measured() -> Outcome {
    let beside = Region::new(DVec2::new(0.5, 0.5), DVec2::new(2.0, 8.0));
    let mut stress = Stress::new(SampleTimes::every(1.0)?).within(beside)?;
    run(Part::block(corners())?, &mut stress)?;
    let mass = Disk::new(DVec2::ZERO, 0.5)?.mass();
    assert!((stress.kinetic().yy.mean() - mass / (1.5 * 7.5)).abs() < 1e-15);
    Ok(())
}

type Make<'a> = Box<dyn Fn() -> Result<Box<dyn Observer>, ParameterError> + 'a>;

/// A gate is taken away, and the walls after it have other indices: measures find them by name, and end a run
/// without the wall. The second of two systems begins a new interval.
#[test]
fn walls_are_found_by_name_and_two_systems_are_not_added() -> Outcome {
    let line = |height: f64| Part::polyline([(2.0, height), (10.0, height)].map(DVec2::from));
    let container = || Container::closed(12.0, 9.0);
    let with_gate = container()?.with_part("gate", line(3.0)?)?.with_part("shelf", line(6.0)?)?;
    let without = container()?.with_part("shelf", line(6.0)?)?.with_part("other", line(7.5)?)?;
    let times = SampleTimes::every(2.0)?;
    let disk = |y: f64| Disk::new(DVec2::new(5.0, y), 0.5).and_then(|disk| disk.with_velocity(DVec2::Y));
    let observers: [Make<'_>; 3] = [
        Box::new(|| Ok(Box::new(Arrivals::at(["shelf"], times)))),
        Box::new(|| Ok(Box::new(WallStress::new(times).with_wall("shelf", 8.0)?))),
        Box::new(|| Ok(Box::new(CollisionHistograms::new(5.0, 5.0, 4)?.with_wall("shelf")))),
    ];
    for make in &observers {
        let mut observer = make()?;
        let mut run = Simulation::builder(Elastic, with_gate.clone()).disks([disk(4.5)?]).build()?;
        run.run_until(5.0, &mut observer)?;
        run.set_boundary(without.clone())?;
        run.run_until(7.0, &mut observer)?;
        run.set_boundary(container()?)?;
        let refused = run.run_until(9.0, &mut observer).unwrap_err();
        let refused = std::error::Error::source(&refused).expect("a cause").to_string();
        assert!(refused.contains("\"shelf\"") && refused.contains("\"floor\", \"left\""), "{refused}");
    }
    let (mut change, mut counts) = (EnergyChange::default(), CollisionCounts::default());
    let mut run = Simulation::builder(Elastic, with_gate.clone()).disks([disk(4.5)?]).build()?;
    run.run_until(5.0, &mut (&mut change, &mut counts))?;
    let hits = counts.collisions_with_wall("shelf");
    run.set_boundary(without)?;
    run.run_until(50.0, &mut (&mut change, &mut counts))?;
    let later = counts.collisions_with_wall("shelf");
    assert!(hits > 0 && later > hits && change.wall("shelf").count() == later, "{hits} {later}");
    let mut arrivals = Arrivals::at(["shelf"], times);
    Simulation::builder(Elastic, with_gate.clone())
        .disks([disk(4.5)?])
        .build()?
        .run_until(3.0, &mut arrivals)?;
    let other = Simulation::builder(Elastic, with_gate).disks([disk(4.5)?]).starting_at(3.0);
    other.build()?.run_until(6.0, &mut arrivals)?;
    assert_eq!(arrivals.times(), [2.0, 6.0]);
    Ok(())
}
