//! The contract of observers: the clock, the messages that composed observers pass on, stops, and the check
//! of the contract.

use std::ops::ControlFlow;

use granular_edmd::boundary::{Boundary, Container, Domain, Region};
use granular_edmd::collision::{Contact, Elastic, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::laws;
use granular_edmd::observable::{
    Accumulator, Arrivals, ByCollisions, CenterOfMass, Collision, CollisionCounts, CollisionHistograms,
    Crossings, EnergyChange, EnergyChangeProfile, Fields, Grid, HeightProfile, MeanSquaredDisplacement,
    Observable, Observer, ObserverError, OrderParameters, PairCorrelation, Partner, SampleTimes, Sampled,
    Series, Snapshot, Stress, Temperatures, TimeCorrelation, Velocities, VelocityDistribution, Verdict,
    WallStress, measured_by, on_collision, on_sample, stop_when, stop_when_sampled,
};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

type Outcome = Result<(), ParameterError>;

fn domain() -> Domain {
    Container::closed(10.0, 10.0).unwrap().domain()
}

fn moment(time: f64) -> Snapshot<'static> {
    Snapshot::new(time, &[], domain(), 1.0).with_wall_count(4)
}

fn snapshot(time: f64) -> Snapshot<'static> {
    Snapshot::new(time, &[], domain(), 1.0)
}

fn collision(time: f64, partner: Partner) -> Collision {
    Collision::new(time, 0, partner, Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0), Impulse::new(1.5, 0.0))
}

/// Runs without disks, as the engine does.
fn run(observer: &mut impl Observer, start: f64, end: f64) {
    observer.on_start(&moment(start)).unwrap();
    while observer.next_sample() <= end {
        observer.on_sample(&snapshot(observer.next_sample().max(start)));
    }
    observer.on_end(&moment(end));
}

/// Times of the samples of runs that follow each other, with this clock.
fn sampled(times: SampleTimes, runs: &[(f64, f64)]) -> Vec<f64> {
    let mut series = Series::new(measured_by(|snapshot: &Snapshot<'_>| snapshot.disks().len()), times);
    for &(start, end) in runs {
        run(&mut series, start, end);
    }
    series.times().to_vec()
}

#[test]
fn the_first_sample_comes_on_the_beat_and_not_at_the_start() -> Outcome {
    let every = SampleTimes::every(2.0)?;
    assert_eq!(sampled(every, &[(0.0, 6.0)]), [2.0, 4.0, 6.0]);
    assert_eq!(sampled(every, &[(11.5, 16.5)]), [12.0, 14.0, 16.0], "a start time off the beat");
    assert_eq!(sampled(every, &[(12.0, 18.0)]), [14.0, 16.0, 18.0], "after a run to settle");
    assert_eq!(sampled(every, &[(-5.0, 1.0)]), [-4.0, -2.0, 0.0], "before time 0");
    let from = SampleTimes::every(2.0)?.starting_at(10.5)?;
    assert_eq!(sampled(from, &[(0.0, 13.0)]), [10.5, 12.5]);
    assert_eq!(sampled(from, &[(10.5, 13.0)]), [10.5, 12.5], "a start on the first time");
    assert_eq!(sampled(from, &[(12.5, 15.0)]), [14.5], "a start on another time");
    assert_eq!(sampled(from, &[(100.0, 103.0)]), [100.5, 102.5]);
    Ok(())
}

/// The intervals are not binary fractions, and the starts are sums of them, each missed by some roundings.
#[test]
fn a_run_of_some_intervals_has_as_many_samples() -> Outcome {
    for interval in [0.1, 1.0 / 3.0, 62.8, 1e-3] {
        for settled in [1, 3, 7, 1000, 12_345] {
            let start = f64::from(settled) * interval;
            for near in [start, start.next_down(), start.next_up(), start * (1.0 - 4e-16)] {
                let end = f64::from(settled + 10) * interval;
                let times = sampled(SampleTimes::every(interval)?, &[(near, end)]);
                assert_eq!(times.len(), 10, "{interval} {settled} {near}");
                assert!(times[0] > start + 0.9 * interval);
                let times = sampled(SampleTimes::every(interval)?.starting_at(start)?, &[(near, end)]);
                assert!(
                    (10..=11).contains(&times.len()) && times[0] <= near.max(start),
                    "{interval} {settled}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn a_run_in_pieces_has_the_samples_of_a_run_in_one() -> Outcome {
    let whole = sampled(SampleTimes::every(0.1)?, &[(0.0, 30.0)]);
    assert_eq!(whole.len(), 300);
    let mut time = 0.0;
    let mut pieces = Vec::new();
    while time < 30.0 {
        // Sums miss the beats, which are multiples, in both directions.
        pieces.push((time, time + 0.1));
        time += 0.1;
    }
    let times = sampled(SampleTimes::every(0.1)?, &pieces);
    assert_eq!(times.len(), 300);
    assert!(times.iter().zip(&whole).all(|(one, other)| (one - other).abs() < 1e-13));
    // A gap leaves out the samples in it.
    let every = SampleTimes::every(1.0)?;
    assert_eq!(sampled(every, &[(0.0, 2.0), (10.0, 12.0)]), [1.0, 2.0, 11.0, 12.0]);
    let from = every.starting_at(5.0)?;
    assert_eq!(sampled(from, &[(5.0, 5.0), (5.0, 6.5), (6.5, 7.0)]), [5.0, 6.0, 7.0], "no beat twice");
    Ok(())
}

#[test]
fn clocks_far_out_do_not_hang() -> Outcome {
    for far in [1e300, f64::MAX, f64::INFINITY, f64::NAN, -1e300, f64::NEG_INFINITY] {
        for interval in [1e-300, 1.0, 1e300] {
            for mut times in [SampleTimes::every(interval)?, SampleTimes::every(interval)?.starting_at(1.0)?]
            {
                times.start_at(far);
                let is_coarse = far.is_finite() && interval < far * f64::EPSILON;
                assert!(times.upcoming().is_nan() >= is_coarse, "{interval} {far}");
                times.advance_past(far);
                assert!(!(far.is_finite() && times.upcoming() <= far), "{interval} {far} {times:?}");
            }
        }
    }
    Ok(())
}

/// Counts its messages, and has a verdict.
#[derive(Debug, Default)]
struct Tally {
    wanted: Option<f64>,
    verdict: Option<&'static str>,
    told: [usize; 4],
}

impl Observer for Tally {
    fn on_start(&mut self, _: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.told[0] += 1;
        Ok(())
    }
    fn on_collision(&mut self, _: &Collision) {
        self.told[1] += 1;
    }
    fn next_sample(&self) -> f64 {
        self.wanted.unwrap_or(f64::INFINITY)
    }
    fn on_sample(&mut self, _: &Snapshot<'_>) {
        self.told[2] += 1;
    }
    fn on_end(&mut self, _: &Snapshot<'_>) {
        self.told[3] += 1;
    }
    fn verdict(&mut self) -> Verdict {
        match self.verdict {
            None => Ok(ControlFlow::Continue(())),
            Some("stop") => Ok(ControlFlow::Break(())),
            Some(error) => Err(error.into()),
        }
    }
}

fn tallies(verdicts: [Option<&'static str>; 6]) -> [Tally; 6] {
    verdicts.map(|verdict| Tally { wanted: Some(1.0), verdict, ..Tally::default() })
}

/// Returns the verdict of all observers together, for each way to compose them.
fn verdict_of(tallies: &mut [Tally; 6]) -> String {
    let [boxed, listed, other, optional, bare, late] = tallies;
    late.wanted = Some(2.0);
    let boxed: Box<dyn Observer + '_> = Box::new(boxed);
    let mut all = (boxed, vec![listed, other], Some(optional), bare, (late, None::<Tally>), ());
    let all: &mut dyn Observer = &mut all;
    all.on_start(&moment(0.0)).unwrap();
    all.on_collision(&collision(0.5, Partner::Wall(0)));
    assert_eq!(all.next_sample(), 1.0);
    all.on_sample(&snapshot(1.0));
    all.on_end(&moment(1.5));
    match all.verdict() {
        Ok(ControlFlow::Continue(())) => "continue".to_owned(),
        Ok(ControlFlow::Break(())) => "stop".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn observers_made_of_others_pass_everything_on() {
    let mut all = tallies([None; 6]);
    assert_eq!(verdict_of(&mut all), "continue");
    let told = all.map(|tally| tally.told);
    assert_eq!(told, [[1; 4], [1; 4], [1; 4], [1; 4], [1; 4], [1, 1, 0, 1]]);
    for place in 0..6 {
        let mut verdicts = [None; 6];
        verdicts[place] = Some("stop");
        assert_eq!(verdict_of(&mut tallies(verdicts)), "stop", "{place}");
        verdicts[5 - place] = Some("disk full");
        assert_eq!(verdict_of(&mut tallies(verdicts)), "disk full", "{place}: a failure comes before a stop");
        verdicts[(5 - place).max(place)] = Some("disk gone");
        verdicts[(5 - place).min(place)] = Some("disk full");
        assert_eq!(verdict_of(&mut tallies(verdicts)), "disk full", "{place}: the first failure");
    }
    let broken = || Tally { wanted: Some(f64::NAN), ..Tally::default() };
    assert!((Tally::default(), broken()).next_sample().is_nan(), "a broken clock shows in a tuple");
    assert!((broken(), Tally::default()).next_sample().is_nan());
    assert!(vec![Tally::default(), broken(), Tally::default()].next_sample().is_nan());
}

#[test]
fn closures_stop_a_run_and_let_it_go_on() -> Outcome {
    let mut at_wall = stop_when(|collision: &Collision| collision.partner == Partner::Wall(0));
    let mut stopped = |partner| {
        at_wall.on_collision(&collision(0.5, partner));
        at_wall.verdict().unwrap().is_break()
    };
    assert_eq!([Partner::Disk(0), Partner::Wall(0), Partner::Disk(0)].map(&mut stopped), [false, true, true]);
    at_wall.on_start(&moment(1.0)).unwrap();
    assert!(at_wall.verdict().unwrap().is_continue());

    let mut late =
        stop_when_sampled(SampleTimes::every(1.0)?, |snapshot: &Snapshot<'_>| snapshot.time() > 2.5);
    late.on_start(&moment(0.5)).unwrap();
    for (time, stops) in [(1.0, false), (2.0, false), (3.0, true)] {
        assert_eq!(late.next_sample(), time);
        late.on_sample(&snapshot(time));
        assert_eq!(late.verdict().unwrap().is_break(), stops, "{time}");
    }
    late.on_start(&moment(3.0)).unwrap();
    assert!(late.verdict().unwrap().is_continue() && late.next_sample() == 4.0);
    Ok(())
}

#[test]
fn all_observers_keep_their_contract() -> Outcome {
    let times = SampleTimes::every(0.7)?;
    let region = granular_edmd::boundary::Region::new([0.0, 0.0].into(), [10.0, 10.0].into());
    let height = measured_by(|snapshot: &Snapshot<'_>| CenterOfMass.measure(snapshot).y);
    let (mut collisions, mut samples) = (0, 0);
    let mut all = (
        (Series::new(CenterOfMass, times), Series::new(height, times.starting_at(-3.0)?)),
        (EnergyChange::default(), CollisionCounts::default()),
        (
            Sampled::new(EnergyChangeProfile::new(0.0, 10.0, 5)?, times),
            Sampled::new(HeightProfile::new(0.0, 10.0, 5)?, times),
        ),
        Sampled::new(Fields::new(Grid::new(region, 3, 3)?), times),
        on_collision(|_: &Collision| collisions += 1),
        on_sample(times, |_: &Snapshot<'_>| samples += 1),
    );
    laws::check(&mut all).unwrap();
    assert!(all.0.0.values().len() > 50 && all.0.1.values().len() > 50);
    assert!(all.1.0.disks().count() > 10 && all.1.1.collisions_with_wall("wall 3") > 10);
    drop(all);
    assert!(collisions > 100 && samples > 50);
    let mut measures = (
        (Sampled::new(PairCorrelation::new(2.0, 4)?, times), MeanSquaredDisplacement::new(3, times)?),
        (
            TimeCorrelation::new(Velocities, 3, times)?,
            Sampled::new(VelocityDistribution::new(3.0, 4)?.about_mean(), times),
        ),
        (Stress::new(times).within(region)?, WallStress::new(times).with_wall("wall 1", 10.0)?),
        CollisionHistograms::new(3.0, 3.0, 4)?,
    );
    laws::check(&mut measures).unwrap();
    assert!(measures.0.0.iter().all(|(_, value)| value.samples() > 50));
    assert!(measures.2.0.tensor().pressure.samples() > 50);
    assert!(measures.3.impulse().count() > 10);
    laws::check(&mut stop_when(|_: &Collision| true)).unwrap();
    laws::check(&mut ByCollisions::new(5, Series::new(Temperatures, times)).unwrap()).unwrap();
    laws::check(&mut stop_when_sampled(times, |_: &Snapshot<'_>| true)).unwrap();
    laws::check(&mut Tally { verdict: Some("disk full"), ..Tally::default() }).unwrap();
    laws::check(&mut ()).unwrap();
    Ok(())
}

/// A clock with a fault.
struct Faulty<F> {
    next: f64,
    started: bool,
    ended: f64,
    after_sample: F,
    at_collision: f64,
}

fn faulty<F: Fn(f64) -> f64>(after_sample: F) -> Faulty<F> {
    Faulty { next: 0.5, started: true, ended: f64::NAN, after_sample, at_collision: 0.0 }
}

impl<F: Fn(f64) -> f64> Observer for Faulty<F> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        // A run that goes on from the last one keeps its clock.
        if self.started && start.time() != self.ended {
            self.next = start.time() + 0.5;
        }
        Ok(())
    }
    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.ended = end.time();
    }
    fn on_collision(&mut self, _: &Collision) {
        self.next += self.at_collision;
    }
    fn next_sample(&self) -> f64 {
        self.next
    }
    fn on_sample(&mut self, _: &Snapshot<'_>) {
        self.next = (self.after_sample)(self.next);
    }
}

#[test]
fn planted_faults_are_caught() {
    let sound = |time: f64| time + 1.0;
    laws::check(&mut faulty(sound)).unwrap();
    laws::check(&mut faulty(|_| f64::INFINITY)).unwrap();
    let found = |observer: &mut dyn Observer| laws::check(observer).unwrap_err().to_string();
    let nan = found(&mut faulty(|_| f64::NAN));
    assert_eq!(nan, "observer, law \"number\": after the time 0.5 the next sample is at NaN");
    let later = "observer, law \"later\": after the sample at";
    let stuck = found(&mut faulty(|time| time));
    assert_eq!(stuck, format!("{later} 0.5 the next one is not later, at 0.5"));
    let late = found(&mut faulty(|time| if time > 9.0 { time } else { time + 1.0 }));
    assert_eq!(late, format!("{later} 9.5 the next one is not later, at 9.5"));
    let back = found(&mut faulty(|time| time - 0.25));
    assert_eq!(back, format!("{later} 0.5 the next one is not later, at 0.25"));
    let deaf = laws::check(&mut Faulty { started: false, ..faulty(sound) }).unwrap_err();
    assert_eq!(deaf.law(), "start", "{deaf}");
    let restless = laws::check(&mut Faulty { at_collision: 0.25, ..faulty(sound) }).unwrap_err();
    assert_eq!(restless.found(), "between two samples the next one moved from 0.5 to 0.75");
    let composed = laws::check(&mut ((), vec![faulty(|_| f64::NAN)])).unwrap_err();
    assert_eq!(composed.law(), "number", "{composed}");
}

#[test]
fn walls_that_were_never_touched_have_no_collisions() {
    let (mut counts, mut change) = (CollisionCounts::default(), EnergyChange::default());
    (&mut counts, &mut change).on_start(&moment(0.0)).unwrap();
    counts.on_collision(&collision(1.0, Partner::Wall(2)));
    change.on_collision(&collision(1.0, Partner::Wall(2)));
    for (wall, expected) in [("wall 0", 0), ("wall 2", 1), ("wall 3", 0), ("wall 9", 0)] {
        assert_eq!((counts.collisions_with_wall(wall), change.wall(wall).count()), (expected, expected));
    }
    assert!(change.wall("wall 2").mean() == -0.75 && change.wall("wall 9").mean().is_nan());
}

/// A wall that is not there, and a series of two runs: errors at the start of the run.
#[test]
fn what_a_run_cannot_measure_ends_it() -> Result<(), Box<dyn std::error::Error>> {
    let gas = || -> Result<_, Box<dyn std::error::Error>> {
        let container = Container::closed(10.0, 10.0)?;
        let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
        Ok(Simulation::builder(Elastic, container).disks(disks).build()?)
    };
    let reason = |error: granular_edmd::simulation::RunError| {
        std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string)
    };
    let mut histograms = CollisionHistograms::new(5.0, 5.0, 1)?.with_wall("ceiling");
    let error = gas()?.run_until(5.0, &mut histograms).unwrap_err();
    assert!(
        reason(error).starts_with("number of walls named \"ceiling\" must be at least 1 (the boundary has")
    );
    gas()?.run_until(5.0, &mut CollisionHistograms::new(5.0, 5.0, 1)?.with_wall("lid"))?;

    // Measures that lie wholly outside would be empty.
    let aside = Grid::new(Region::new(DVec2::new(11.0, 0.0), DVec2::new(12.0, 9.0)), 1, 1)?;
    let below = Grid::new(Region::new(DVec2::new(0.0, -2.0), DVec2::new(9.0, 0.0)), 1, 1)?;
    let velocities = VelocityDistribution::new(4.0, 8)?.about_flow(aside);
    let outside: [(&str, Box<dyn Observer>); 5] = [
        ("left edge of the grid", Box::new(clocked(Fields::new(aside))?)),
        ("lower edge of the grid", Box::new(clocked(Fields::new(below))?)),
        ("left edge of the grid", Box::new(clocked(velocities)?)),
        ("bottom of the profile", Box::new(clocked(HeightProfile::new(10.0, 20.0, 3)?)?)),
        ("bottom of the profile", Box::new(clocked(EnergyChangeProfile::new(-9.0, -1.0, 3)?)?)),
    ];
    for (name, mut observer) in outside {
        let said = reason(gas()?.run_until(3.0, &mut observer).unwrap_err());
        assert!(said.contains(name) && said.contains("inside the domain, but is"), "{said}");
    }
    gas()?.run_until(3.0, &mut clocked(HeightProfile::new(9.0, 20.0, 3)?)?)?;

    let mut series = Series::new(OrderParameters, SampleTimes::every(1.0)?);
    let mut first = gas()?;
    first.run_until(3.0, &mut series)?;
    first.run_until(5.0, &mut series)?;
    let error = reason(gas()?.run_until(3.0, &mut series).unwrap_err());
    assert!(error.contains("start of the run must be not before the last sample of the series"), "{error}");
    assert_eq!(series.times(), [1.0, 2.0, 3.0, 4.0, 5.0]);
    Ok(())
}

fn clocked<A>(accumulator: A) -> Result<Sampled<A>, granular_edmd::ParameterError> {
    Ok(Sampled::new(accumulator, SampleTimes::every(1.0)?))
}

/// The mean velocity and the flow can be asked for in either order, and neither is forgotten.
#[test]
fn a_flow_includes_the_mean() -> Result<(), Box<dyn std::error::Error>> {
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::splat(10.0)), 2, 2)?;
    let new = || VelocityDistribution::new(4.0, 8);
    assert_eq!(new()?.about_flow(grid).about_mean(), new()?.about_flow(grid));
    assert_eq!(new()?.about_mean().about_flow(grid), new()?.about_flow(grid));
    assert_ne!(new()?.about_mean(), new()?);
    Ok(())
}

/// An accumulator adds the same snapshots with and without a clock.
#[test]
fn an_accumulator_alone_measures_as_in_a_run() -> Result<(), Box<dyn std::error::Error>> {
    let container = Container::closed(10.0, 10.0)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 20, 0.5)?, 1.0, 1)?;
    let new = || HeightProfile::new(0.0, 10.0, 5);
    let (mut alone, mut sampled) = (new()?, Sampled::new(new()?, SampleTimes::every(0.7)?));
    let mut by_hand =
        on_sample(SampleTimes::every(0.7)?, |snapshot: &Snapshot<'_>| alone.add(snapshot).unwrap());
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    run.run_until(20.0, &mut (&mut sampled, &mut by_hand))?;
    assert_eq!((sampled.samples(), sampled.into_inner()), (28, alone));
    Ok(())
}

/// Half of the disks are exchanged during the run: each of the others is followed by its id.
#[test]
fn displacements_are_those_of_the_same_disks() -> Result<(), Box<dyn std::error::Error>> {
    let container = Container::periodic(10.0, 10.0)?;
    let disk = |x: f64, speed: f64| Disk::new(DVec2::new(x, 5.0), 0.1)?.with_velocity(DVec2::Y * speed);
    let disks = (0..8).map(|n| disk(0.5 + f64::from(n), 1.0)).collect::<Result<Vec<_>, _>>()?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let times = SampleTimes::every(1.0)?;
    let mut displacement = MeanSquaredDisplacement::new(6, times)?;
    let mut velocities = TimeCorrelation::new(Velocities, 6, times)?;
    run.run_until(5.0, &mut (&mut displacement, &mut velocities))?;
    // The second comes back as the last one, the others that leave are replaced by faster ones.
    let gone = run.remove(|disk, _| disk < 4)?;
    run.insert(gone.iter().skip(3).copied())?;
    run.insert([disk(0.5, 3.0)?, disk(1.5, 3.0)?, disk(2.5, 3.0)?])?;
    assert_eq!(run.disks().iter().map(Disk::id).collect::<Vec<_>>(), [5, 6, 7, 8, 4, 9, 10, 11]);
    run.run_until(10.0, &mut (&mut displacement, &mut velocities))?;
    // No pair of samples more than 5 apart sees a fast disk at both ends: the first of them is at 6.
    let squared: Vec<f64> = displacement.iter().map(|(_, squared)| squared.mean()).collect();
    assert!((squared[6] - 36.0).abs() < 1e-9, "{squared:?}");
    let products: Vec<f64> = velocities.iter().map(|(_, product)| product.mean()).collect();
    assert!((products[6] - 1.0).abs() < 1e-12, "{products:?}");
    // Five of eight at speed 1, three at 3, in half of the samples.
    assert!(products[1] > 1.5 && products[1] < 4.0, "{products:?}");
    Ok(())
}

/// Rates need equal intervals: a clock at equal ratios is refused when the run starts, by name.
#[test]
fn observers_of_intervals_refuse_ratios() {
    let times = SampleTimes::at_ratio(1.0, 2.0).unwrap();
    let line = [DVec2::new(0.0, 4.0), DVec2::new(8.0, 4.0)];
    let (mut arrivals, mut crossings) =
        (Arrivals::at(["floor"], times), Crossings::new(line, times).unwrap());
    let observers: [&mut dyn Observer; 2] = [&mut arrivals, &mut crossings];
    for observer in observers {
        let container = Container::closed(8.0, 8.0).unwrap();
        let disks = initial::lattice(&container, 4, 0.5).unwrap();
        let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
        let error =
            std::error::Error::source(&run.run_until(3.0, observer).unwrap_err()).map(ToString::to_string);
        assert!(error.as_ref().is_some_and(|text| text.contains("equal intervals")), "{error:?}");
    }
}
