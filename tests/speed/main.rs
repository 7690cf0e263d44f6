//! Reports count what a run did, standard states are what they say, and comparisons tell noise.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{ContactDuration, Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::EnergyChange;
use granular_edmd::scheduler::BucketQueue;
use granular_edmd::speed::{self, Comparison, Finding, Meter, Quartiles, RunReport};
use granular_edmd::{Disk, Simulation, initial};

fn gas() -> Simulation<Elastic> {
    let container = Container::periodic(20.0, 20.0).unwrap();
    let disks = initial::even_lattice(&container, 200, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    Simulation::builder(Elastic, container).disks(disks).build().unwrap()
}

#[test]
fn a_report_counts_what_the_run_did_since_its_meter_started() {
    let mut run = gas();
    run.run_until(5.0, &mut ()).unwrap();
    let (before, meter) = (*run.counters(), Meter::start(&run));
    run.run_until(15.0, &mut EnergyChange::default()).unwrap();
    let report = meter.report(&run);
    let done = run.counters().since(&before);
    assert_eq!((report.counters, report.disks, report.simulated_time), (done, 200, 10.0));
    assert!(report.seconds > 0.0);
    let nanoseconds = 1e9 * report.seconds / done.disk_collisions as f64;
    assert_eq!(report.nanoseconds_per_collision, nanoseconds);
    assert!((report.collisions_per_second * nanoseconds - 1e9).abs() < 1.0);
    assert!((report.events_per_collision - done.events() as f64 / done.disk_collisions as f64).abs() < 1e-12);
    let text = report.to_string();
    for part in ["200 disks, 10.000000 units", "million collisions a second", "horizons"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_run_without_collisions_reports_no_numbers_for_them() {
    let run = Simulation::builder(Elastic, Container::closed(4.0, 4.0).unwrap()).build().unwrap();
    let report = Meter::start(&run).report(&run);
    assert!(!report.nanoseconds_per_collision.is_finite() && report.events_per_collision.is_nan());
    assert!(report.to_string().contains("0 disks"));
}

#[test]
fn runs_without_collisions_are_not_compared() {
    let disk = Disk::new(DVec2::splat(2.0), 0.5).unwrap().with_velocity(DVec2::X).unwrap();
    let alone = Simulation::builder(Elastic, Container::closed(4.0, 4.0).unwrap());
    let (alone, many) = (alone.disks([disk]).build().unwrap(), gas());
    let comparison =
        Comparison::between(|| speed::measure(&alone, 100, &mut ()), || speed::measure(&many, 100, &mut ()))
            .unwrap();
    assert_eq!(comparison.finding(), Finding::Unknown);
    assert!(comparison.to_string().contains("not known, as no two disks collided"), "{comparison}");
}

#[cfg(feature = "serde")]
#[test]
fn a_report_is_json() {
    let run = gas();
    let report = speed::measure(&run, 1000, &mut ()).unwrap();
    let json: serde_json::Value = serde_json::to_value(&report).unwrap();
    assert_eq!(json["disks"], 200);
    assert_eq!(json["counters"]["disk_collisions"], 1000);
}

#[test]
fn a_measurement_does_the_same_work_each_time_and_leaves_the_run_as_it_is() {
    let run = gas();
    let [one, two] = [(); 2].map(|()| speed::measure(&run, 3000, &mut ()).unwrap().counters);
    assert_eq!((one, one.disk_collisions, run.counters().events()), (two, 3000, 0));
}

#[test]
fn parts_of_other_types_take_the_place_of_the_built_in_ones() {
    let [mut one, other] = [(); 2].map(|()| gas());
    let walls = other.boundary().clone();
    // An elastic rule, another scheduler and the same walls: the same trajectory.
    let rule = Frictional::from_inelasticity(0.0, 0.0, 0.0).unwrap();
    let mut other = other.with_rule(rule).with_scheduler(BucketQueue::new()).with_boundary(walls).unwrap();
    for run_end in [3.0, 7.0] {
        one.run_until(run_end, &mut ()).unwrap();
        other.run_until(run_end, &mut ()).unwrap();
    }
    assert_eq!(one.disks(), other.disks());
    assert!(other.with_boundary(Container::closed(5.0, 5.0).unwrap()).is_err());
}

#[test]
fn standard_states_have_settled_to_what_they_say() {
    let height = |run: &speed::PaperBox| run.disks().iter().map(|disk| disk.position().y).sum::<f64>() / 1e3;
    let (dilute, dense) = (speed::dilute().unwrap(), speed::dense().unwrap());
    assert!((40.0..55.0).contains(&height(&dilute)), "{}", height(&dilute));
    assert!((9.0..13.0).contains(&height(&dense)), "{}", height(&dense));
    assert_eq!(dense.rule(), &ContactDuration::new(*dense.rule().rule(), 1e-5).unwrap());
}

/// Returns a comparison of a run with one that takes so many times as long, when the machine slows both now
/// and then and adds noise to each.
fn compared(slower: f64, noise: f64) -> Comparison {
    let report = speed::measure(&gas(), 1000, &mut ()).unwrap();
    let measured = |times: f64, seed: usize| {
        let (report, mut count) = (report.clone(), seed);
        move || -> Result<RunReport, std::convert::Infallible> {
            count += 1;
            let scattered = (count.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f64 / f64::from(1 << 24);
            let mut report = report.clone();
            report.nanoseconds_per_collision = 200.0 * times * (1.0 + noise * (scattered - 0.5));
            Ok(report)
        }
    };
    let Ok(comparison) = Comparison::between(measured(1.0, 0), measured(slower, 1 << 20));
    comparison
}

#[test]
fn a_difference_is_told_from_noise_and_five_percent_from_one() {
    assert_eq!(compared(1.0, 0.04).finding(), Finding::Noise);
    assert_eq!(compared(1.05, 0.04).finding(), Finding::Slower);
    assert_eq!(compared(0.95, 0.04).finding(), Finding::Faster);
    assert_eq!(compared(1.05, 0.6).finding(), Finding::Noise);
    let [one, five] = [1.01, 1.05].map(|times| compared(times, 0.02).interval());
    assert!(one[1] < five[0], "{one:?} {five:?}");
    assert!(compared(1.05, 0.04).to_string().contains("slower"));
}

#[test]
fn quartiles_of_nothing_are_no_numbers() {
    assert!(Quartiles::of([]).median.is_nan());
    assert_eq!(Quartiles::of([2.0]), Quartiles { low: 2.0, median: 2.0, high: 2.0 });
}
