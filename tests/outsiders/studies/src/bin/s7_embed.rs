use granular_edmd::prelude::*;
use granular_edmd::simulation::{BoxedBoundary, BoxedRule, BoxedScheduler, BoxedSimulation, RunEnd, RunError};
use granular_edmd::scheduler::{BySize, EventScheduler, TournamentTree};
use granular_edmd::simulation::*;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, Mutex, atomic::{AtomicBool, Ordering}, mpsc};
use visco::Visco;
use granular_edmd::collision::Friction;
fn send_sync<T: Send + Sync>() {}
#[derive(Serialize, Deserialize)]
struct Saved { label: String, checkpoint: Checkpoint, series: Series<CenterOfMass> }
trait AnyRun: Send { fn advance(&mut self, t: f64) -> Result<RunEnd, RunError>; fn energy(&self) -> f64; fn save(&self) -> Checkpoint; }
impl<R: CollisionRule + Send, B: Boundary + Send, S: EventScheduler + Send> AnyRun for Simulation<R, B, S> {
    fn advance(&mut self, t: f64) -> Result<RunEnd, RunError> { self.run_until(t, &mut ()) }
    fn energy(&self) -> f64 { self.measure(&Energies).translational }
    fn save(&self) -> Checkpoint { self.checkpoint() }
}
fn container() -> anyhow::Result<Container> { Ok(Container::closed(20.0, 50.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?) }
fn rule() -> anyhow::Result<ContactDuration<Visco>> { Ok(ContactDuration::new(Visco::new(0.1, 0.02, Friction::from_inelasticity(0.05, 0.2)?)?, 1e-4)?) }
fn sim() -> anyhow::Result<Simulation<ContactDuration<Visco>>> {
    let c = container()?; let d = initial::with_maxwellian_velocities(initial::lattice(&c, 100, 0.5)?, 0.5, 1)?;
    Ok(Simulation::builder(rule()?, c).disks(d).gravity(0.015625).build()?)
}
fn generic<R: CollisionRule, S: EventScheduler>(s: &mut Simulation<R, Container, S>) -> Result<f64, RunError> { s.run_until(s.time() + 1.0, &mut ())?; Ok(s.time()) }
fn main() -> anyhow::Result<()> {
    let args: Vec<_> = std::env::args().collect();
    send_sync::<Simulation<ContactDuration<Visco>>>(); send_sync::<BoxedSimulation>(); send_sync::<Checkpoint>();
    let dir = "out/out7"; std::fs::create_dir_all(dir)?;
    match args.get(1).map(String::as_str) {
        Some("json") => {
            let s: Saved = serde_json::from_str(&std::fs::read_to_string(format!("{dir}/c.json"))?)?;
            let mut series = s.series; let mut r = Simulation::resume(&s.checkpoint, rule()?, container()?).build()?;
            r.run_until(400.0, &mut series)?; println!("json {} {:?} {}", s.label, r.disks()[7], series.values().len());
        }
        Some("postcard") => {
            let s: Saved = postcard::from_bytes(&std::fs::read(format!("{dir}/c.bin"))?)?;
            let mut series = s.series; let mut r = Simulation::resume(&s.checkpoint, rule()?, container()?).build()?;
            r.run_until(400.0, &mut series)?; println!("post {} {:?} {}", s.label, r.disks()[7], series.values().len());
        }
        _ => {
            // thread, progress, cancel
            let stop = Arc::new(AtomicBool::new(false)); let (tx, rx) = mpsc::channel();
            let progress = Arc::new(Mutex::new(0.0));
            let handle = { let (stop, progress) = (stop.clone(), progress.clone()); std::thread::spawn(move || -> Result<_, anyhow::Error> {
                let mut s = sim()?;
                let mut tick = granular_edmd::observable::on_sample(SampleTimes::every(1.0)?, |snap: &Snapshot<'_>| { *progress.lock().unwrap() = snap.time(); let _ = tx.send(snap.time()); });
                let end = s.run(&Limits::until(1e9).with_interrupt(&stop), &mut tick)?;
                Ok((end, s.time()))
            }) };
            for _ in 0..50 { rx.recv()?; }
            stop.store(true, Ordering::Relaxed);
            println!("cancelled {:?}", handle.join().unwrap()?);
            let mut s = sim()?; let mut series = Series::new(CenterOfMass, SampleTimes::every(10.0)?);
            s.run_until(200.3, &mut series)?;
            let saved = Saved { label: "x".into(), checkpoint: s.checkpoint(), series };
            std::fs::write(format!("{dir}/c.json"), serde_json::to_string(&saved)?)?;
            std::fs::write(format!("{dir}/c.bin"), postcard::to_stdvec(&saved)?)?;
            println!("json {} bytes, postcard {}", std::fs::metadata(format!("{dir}/c.json"))?.len(), std::fs::metadata(format!("{dir}/c.bin"))?.len());
            let Saved { mut series, .. } = saved; s.run_until(400.0, &mut series)?;
            println!("whole x {:?} {}", s.disks()[7], series.values().len());
            // other rule refused? b differs
            let other = ContactDuration::new(Visco::new(0.1, 0.021, Friction::from_inelasticity(0.05, 0.2)?)?, 1e-4)?;
            println!("other rule: {:?}", Simulation::resume(&s.checkpoint(), other, container()?).build().map(|_| ()).map_err(|e| e.to_string()));
            let mut many: Vec<Box<dyn AnyRun>> = vec![Box::new(sim()?), Box::new(sim()?.with_rule(Elastic)), Box::new(sim()?.with_scheduler(TournamentTree::new())), Box::new(sim()?.with_rule(Box::new(Smooth::from_restitution(0.99)?) as BoxedRule))];
            for m in &mut many { m.advance(20.0)?; println!("E {} t {}", m.energy(), m.save().time()); }
            let c: BoxedBoundary = Box::new(container()?);
            let r: BoxedRule = Box::new(rule()?);
            let d = sim()?.disks();
            let mut b: Vec<BoxedSimulation> = vec![Simulation::builder(r, c).disks(d).gravity(0.015625).scheduler(Box::new(BySize::new()) as BoxedScheduler).build()?];
            b[0].run_until(20.0, &mut ())?; println!("boxed {}", b[0].measure(&Energies).translational);
            let bad: Box<dyn CollisionRule> = Box::new(Elastic); let _ = bad;
            println!("generic {}", generic(&mut sim()?)?);
        }
    }
    Ok(())
}
