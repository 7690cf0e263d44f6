use granular_edmd::prelude::*;
use granular_edmd::Fingerprint;
use granular_edmd::observable::{Accumulator, Heading, Observable, Sampled, Snapshot, Table, Tabular};
use granular_edmd::statistics::BlockedMean;
use granular_edmd_study::{Axis, Column, Control, Course, Experiment, ExperimentError, Plan, Protocol, Ramp, Study};
use serde::{Deserialize, Serialize};
/// Mean |psi6| over the neighbors within 1.5 sigma, and mean coordination within 1.05 sigma.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Order;
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct OrderValue { psi6: f64, coordination: f64 }
impl Observable for Order {
    type Value = OrderValue;
    fn measure(&self, s: &Snapshot<'_>) -> OrderValue {
        let d = s.disks(); let dom = s.domain();
        // own cell list: the crate has neighbor cells, but none that a measurement can use
        let w = 1.5; let mut cells = std::collections::HashMap::<(i64, i64), Vec<usize>>::new();
        for (k, d) in d.iter().enumerate() { let p = d.position(); cells.entry(((p.x / w).floor() as i64, (p.y / w).floor() as i64)).or_default().push(k); }
        let (mut psi, mut z) = (0.0, 0u64);
        for a in d {
            let p = a.position(); let (cx, cy) = ((p.x / w).floor() as i64, (p.y / w).floor() as i64);
            let (mut re, mut im, mut n) = (0.0, 0.0, 0u32);
            for x in cx - 1..=cx + 1 { for y in cy - 1..=cy + 1 { for &k in cells.get(&(x, y)).into_iter().flatten() {
                let r = dom.separation(p, d[k].position()); let l = r.length();
                if l == 0.0 || l > 1.5 { continue }
                let t = 6.0 * libm::atan2(r.y, r.x); re += libm::cos(t); im += libm::sin(t); n += 1;
                z += u64::from(l < 1.05);
            } } }
            if n > 0 { psi += libm::hypot(re, im) / f64::from(n) }
        }
        let n = d.len() as f64;
        OrderValue { psi6: psi / n, coordination: z as f64 / n }
    }
}
impl Tabular for Order {
    fn headings(&self) -> Vec<Heading> { vec![Heading::new("psi6", "1"), Heading::new("coordination", "1")] }
    fn add_numbers(&self, v: &OrderValue, row: &mut Vec<f64>) { row.extend([v.psi6, v.coordination]) }
}
/// Granular temperature by height, with errors from blocks.
struct TemperatureProfile { top: f64, bins: Vec<BlockedMean> }
impl Accumulator for TemperatureProfile {
    fn add(&mut self, s: &Snapshot<'_>) -> Result<(), granular_edmd::ParameterError> {
        let n = self.bins.len(); let mut sums = vec![(0u32, DVec2::ZERO, 0.0); n];
        for d in s.disks() { let k = (d.position().y / self.top * n as f64) as usize; if k < n { let e = &mut sums[k]; e.0 += 1; e.1 += d.velocity(); e.2 += d.mass() * d.velocity().length_squared(); } }
        for (b, (c, p, e)) in self.bins.iter_mut().zip(sums) { if c > 1 { let c = f64::from(c); b.push(0.5 * (e - p.length_squared() / c) / (c - 1.0)); } }
        Ok(())
    }
}
impl Table for TemperatureProfile {
    fn headings(&self) -> Vec<Heading> { [("height", "length"), ("temperature", "energy"), ("temperature_error", "energy"), ("temperature_samples", "1")].map(|(n, u)| Heading::new(n, u)).into() }
    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let h = self.top / self.bins.len() as f64;
        Box::new(self.bins.iter().enumerate().map(move |(k, b)| { let e = b.estimate(); vec![(k as f64 + 0.5) * h, e.mean(), e.standard_error(), e.independent_samples()] }))
    }
}
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Shaken { acceleration: f64 }
impl Experiment for Shaken {
    type Rule = LeastRebound<Frictional>; type Boundary = Container; type Observer = (); type Sample = OrderValue;
    fn revision() -> Fingerprint { Fingerprint::of("Shaken 1") }
    fn rule(&self) -> Result<Self::Rule, ExperimentError> { Ok(LeastRebound::new(Frictional::from_inelasticity(0.05, 0.05, 0.1)?, 0.02)?) }
    fn boundary(&self) -> Result<Container, ExperimentError> { let w = 3.0; Ok(Container::open(20.0)?.with_motion(Wall::Floor, Sinusoidal::new(self.acceleration / (w * w), w)?)?) }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> { Ok(initial::with_maxwellian_velocities(initial::lattice(&self.boundary()?, 120, 0.5)?, 0.1, seed)?) }
    fn gravity(&self) -> Gravity { 1.0.into() }
    fn cycle(&self) -> f64 { std::f64::consts::TAU / 3.0 }
    fn observer(&self) -> Result<(), ExperimentError> { Ok(()) }
    fn sample(&self, s: &Snapshot<'_>, _: &mut ()) -> OrderValue { Order.measure(s) }
    fn columns() -> Vec<Column<Self>> { vec![Column::sampled("psi6", "1", |v: &OrderValue| v.psi6), Column::sampled("coordination", "1", |v: &OrderValue| v.coordination)] }
}
fn main() -> anyhow::Result<()> {
    let e = Shaken { acceleration: 4.0 };
    let c = e.boundary().map_err(|e| anyhow::anyhow!(e))?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&c, 200, 0.5)?, 0.1, 1)?;
    let mut sim = Simulation::builder(e.rule().map_err(|e| anyhow::anyhow!(e))?, c).disks(disks).gravity(1.0).build()?;
    sim.run_until(100.0, &mut ())?;
    let mut series = Series::new((Order, CenterOfMass), SampleTimes::every(0.7)?);
    let mut profile = Sampled::new(TemperatureProfile { top: 16.0, bins: vec![BlockedMean::new(); 8] }, SampleTimes::every(0.7)?);
    sim.run_until(600.0, &mut (&mut series, &mut profile))?;
    println!("psi6 {}  z {}", series.mean(|v| v.0.psi6)?, series.mean(|v| v.0.coordination)?);
    std::fs::create_dir_all("out/out6")?;
    series.write_csv(std::fs::File::create("out/out6/series.csv")?)?;
    profile.write_csv(std::fs::File::create("out/out6/profile.csv")?)?;
    let plan = Plan::new(Shaken { acceleration: 2.0 }, Protocol::new(40, 60, 1)?.with_phase(0.3)?, 1)?
        .with_ramp(Ramp::new("acceleration", [2.0, 2.5, 3.0, 4.0, 6.0], Course::UpAndDown)?)?.with_repeats(2)?;
    let _ = Axis::new("acceleration", [1.0])?;
    let study = Study::open_or_create("out/out6/study2", &plan)?;
    println!("{:?}", study.run(&Control::default())?);
    for p in study.points() { let p = p?; println!("{:?} a {} psi6 {} z {}", p.leg(), p.experiment().acceleration, p.mean(|v| v.psi6), p.mean(|v| v.coordination)); }
    Ok(())
}
