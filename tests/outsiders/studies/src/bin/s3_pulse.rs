use granular_edmd::prelude::*;
use granular_edmd::Fingerprint;
use granular_edmd::wall::{AccelerationBounds, WallState, laws};
use granular_edmd::observable::{Fields, Grid, Sampled, Table};
/// Half-sine pulses of height h, duration d, one each period, rest between.
#[derive(Debug, Clone, Copy)]
struct Pulse { h: f64, d: f64, period: f64 }
impl Pulse {
    fn at(&self, phase: f64) -> (f64, f64) { let k=(phase/self.period).floor(); (phase-k*self.period, k*self.period) }
}
impl WallMotion for Pulse {
    fn state(&self, phase: f64) -> WallState {
        let (t,_) = self.at(phase);
        if t >= self.d { return WallState::new(0.0, 0.0); }
        let w = std::f64::consts::PI/self.d;
        WallState::new(self.h*libm::sin(w*t), self.h*w*libm::cos(w*t))
    }
    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let (t,b) = self.at(phase);
        if t >= self.d { return AccelerationBounds::new(b+self.period, 0.0, 0.0); }
        let w = std::f64::consts::PI/self.d;
        let a = |t: f64| -self.h*w*w*libm::sin(w*t);
        let e = (t + self.d/16.0).min(self.d);
        // monotone on each half; the extreme is at d/2
        let (lo, hi) = (a(t).min(a(e)), a(t).max(a(e)));
        let lo = if t < self.d/2.0 && e > self.d/2.0 { -self.h*w*w } else { lo };
        AccelerationBounds::new(b+e, lo, hi)
    }
    fn reach(&self) -> (f64, f64) { (0.0, self.h) }
    fn period(&self) -> Option<f64> { Some(self.period) }
    fn fingerprint(&self) -> Option<Fingerprint> { Some(Fingerprint::of("pulse").number(self.h).number(self.d).number(self.period)) }
}
fn main() -> anyhow::Result<()> {
    let base = Pulse { h: 0.5, d: 1.0, period: 3.0 };
    println!("laws {:?}", laws::check(&base, 0.0, 60.0));
    println!("laws negative {:?}", laws::check(&base, -60.0, 0.0));
    let c = Container::closed(40.0, 60.0)?.with_motion(Wall::Floor, base)?;
    let disks = initial::scattered(&c, 400, 0.5, 30.0, 1)?;
    let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.4)?, 0.05)?;
    for tilt in [0.0_f64, 5.0, 10.0] {
        let mut sim = Simulation::builder(rule.clone(), c.clone()).disks(disks.clone()).gravity(Gravity::tilted(1.0, tilt.to_radians())?).build()?;
        let t0 = std::time::Instant::now();
        sim.run_until(150.0, &mut ())?;
        let mut f = Sampled::new(Fields::new(Grid::new(granular_edmd::boundary::Region::new(DVec2::ZERO, DVec2::new(40.0, 60.0)), 8, 1)?), SampleTimes::every(3.0)?);
        sim.run_until(450.0, &mut f)?;
        println!("tilt {tilt}: packing by column {:?}  {:.1}s collisions {:?} warnings {:?}", f.iter().map(|c| (c.packing_fraction*1000.0).round()/1000.0).collect::<Vec<_>>(), t0.elapsed().as_secs_f64(), sim.counters().disk_collisions+sim.counters().wall_collisions, sim.warnings());
        f.write_csv(std::fs::File::create(format!("out/heap{tilt}.csv"))?)?;
    }
    Ok(())
}
