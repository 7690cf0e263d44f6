//! Measures that divide by areas, among walls for some kinds of disks only.

use granular_edmd::boundary::{Container, Part, Region, Vessel};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Fields, Grid, HeightProfile, Observer, OfKind, SampleTimes, Sampled, Stress,
};
use granular_edmd::{Disk, Kind, Simulation};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const KIND: Kind = Kind::new(1);

/// Runs one disk of the kind in a box with a part for this kind.
fn run(part: Part, observer: &mut impl Observer) -> Outcome {
    let vessel = Vessel::new(Container::closed(12.0, 9.0)?).with("part", part.only_for([KIND]))?;
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
        assert!(text.contains("free area") && text.contains("parts with an inside for all kinds"), "{text}");
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
