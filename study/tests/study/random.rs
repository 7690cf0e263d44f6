//! Random studies, interrupted and damaged at random.

use granular_edmd_study::vibrated_box::{Base, Sides, VibratedBox};
use granular_edmd_study::{Axis, Control, Course, Plan, PlanError, Protocol, Ramp, Study};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use crate::logs;
use crate::support::{BASE, Scratch, assert_same, done, run_with_interruptions};
use support::cases::config;

fn plan() -> impl Strategy<Value = Plan<VibratedBox>> {
    let base = select(vec![BASE, Base::Thermal { temperature: 1.0, slip: true }]);
    let sides = select(vec![Sides::Hard, Sides::Elastic, Sides::Periodic]);
    let protocol = (0..9_u64, 1..5_u64, 1..6_u64, select(vec![0.25, 0.5, 1.0]));
    let course = select(vec![Course::Up, Course::Down, Course::UpAndDown]);
    let frictions = (0..4_usize, course);
    (any::<u32>(), base, sides, protocol, frictions, 0..3_usize, 1..3_usize, any::<bool>()).prop_map(
        |(seed, base, sides, protocol, ramp, sweep, repeats, keeps_states)| {
            let mut bed = VibratedBox::new(20, 10.0, base).with_height(30.0).with_gravity(0.015_625);
            bed.sides = sides;
            let bed = bed.with_contact_duration(1e-4);
            planned(bed, u64::from(seed), protocol, ramp, sweep, repeats, keeps_states).unwrap()
        },
    )
}

fn planned(
    bed: VibratedBox,
    seed: u64,
    (settle, samples, every, phase): (u64, u64, u64, f64),
    (frictions, course): (usize, Course),
    inelasticities: usize,
    repeats: usize,
    keeps_states: bool,
) -> Result<Plan<VibratedBox>, PlanError> {
    let mut plan = Plan::new(bed, Protocol::new(settle, samples, every)?.with_phase(phase)?, seed)?;
    if frictions > 0 {
        let values: Vec<f64> = [0.02, 0.1, 0.4].into_iter().take(frictions).collect();
        plan = plan.with_ramp(Ramp::new("friction", values, course)?)?;
    }
    if inelasticities > 0 {
        plan = plan.with_axis(Axis::new("inelasticity", [0.01, 0.03].into_iter().take(inelasticities))?)?;
    }
    let plan = plan.with_repeats(repeats)?;
    Ok(if keeps_states { plan.with_end_states() } else { plan })
}

proptest! {
    #![proptest_config(config(12))]

    /// Whatever is planned, and whenever it is interrupted: the files are those of a run without a break, and
    /// records that are damaged or lost are done again.
    #[test]
    fn random_studies_end_with_the_same_bytes(
        plan in plan(), breaks in prop::collection::vec(1..12_u64, 1..4), hit: Index, left: Index, lost: bool,
    ) {
        let (expected, _) = done(&plan, "random-unbroken");
        let scratch = Scratch::new("random");
        let steps = |run: u64| breaks.get(run as usize).copied().unwrap_or(10 + run);
        run_with_interruptions(&scratch.0, &plan, steps, |_| ());
        assert_same(&scratch.0, &expected.0);

        let names: Vec<_> = logs::records(&scratch.0).into_keys().collect();
        let number = |name: &std::ffi::OsStr| name.to_str().unwrap().parse::<u32>().unwrap();
        let record = hit.get(&names);
        let value = number(record.file_name().unwrap());
        let ramp = number(record.parent().and_then(std::path::Path::file_name).unwrap());
        if lost {
            logs::forget(&scratch.0, ramp, value);
        } else {
            let contents = logs::record(&scratch.0, ramp, value);
            logs::replace(&scratch.0, ramp, value, &contents[..left.index(contents.len())]);
        }
        let summary = Study::open_or_create(&scratch.0, &plan)?.run(&Control::default().with_verification())?;
        prop_assert!(summary.is_complete());
        assert_same(&scratch.0, &expected.0);
    }
}
