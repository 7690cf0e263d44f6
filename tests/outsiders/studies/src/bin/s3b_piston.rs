//! A lid of finite mass on a spring: exact, by a rule of reduced mass on the lid and a new motion after each
//! touch.
use granular_edmd::prelude::*;
use granular_edmd::wall::{AccelerationBounds, WallState};
use granular_edmd::simulation::Event;
use granular_edmd::collision::from_fn;
#[derive(Clone, Copy, Debug)]
struct Piston { t0: f64, x0: f64, v0: f64, w: f64 }   // x: displacement into the box
impl Piston { fn at(&self, t: f64) -> (f64,f64) { let s=self.w*(t-self.t0); (self.x0*libm::cos(s)+self.v0/self.w*libm::sin(s), -self.x0*self.w*libm::sin(s)+self.v0*libm::cos(s)) } }
impl WallMotion for Piston {
    fn state(&self, t: f64) -> WallState { let (x,v)=self.at(t); WallState::new(x,v) }
    fn acceleration(&self, t: f64) -> AccelerationBounds {
        let amp=(self.x0*self.x0+self.v0*self.v0/self.w/self.w).sqrt();
        AccelerationBounds::from_jerk(t, -self.w*self.w*self.at(t).0, amp*self.w.powi(3), std::f64::consts::TAU/self.w/16.0) }
    fn reach(&self) -> (f64,f64) { let a=(self.x0*self.x0+self.v0*self.v0/self.w/self.w).sqrt()*(1.0+1e-12); (-a,a) }
}
fn main() -> anyhow::Result<()> {
    let (mass, w, m) = (20.0_f64, 0.5_f64, 1.0_f64);
    let rule = move || from_fn(move |c: &Contact| Impulse::new(2.0*c.closing_speed()*m*mass/(m+mass), 0.0));
    let make = |p: Piston| -> anyhow::Result<Container> { Ok(Container::closed(20.0,20.0)?.with_motion(Wall::Lid, p)?.with_rule(Wall::Lid, rule())?) };
    let mut p = Piston { t0: 0.0, x0: 0.0, v0: 0.0, w };
    let c = make(p)?;
    let lid = c.index(Wall::Lid).unwrap();
    let disks = initial::with_maxwellian_velocities(initial::scattered(&c, 150, 0.5, 18.0, 1)?, 1.0, 1)?;
    let mut sim = Simulation::builder(Elastic, c).disks(disks).build()?;
    let e = |s: &Simulation<Elastic>, p: &Piston| { let (x,v)=p.at(s.time()); s.disks().iter().map(Disk::translational_energy).sum::<f64>()+0.5*mass*(v*v+w*w*x*x) };
    let e0 = e(&sim,&p);
    let t = std::time::Instant::now();
    let (mut hits, mut xs, mut vs) = (0u64, 0.0, 0.0);
    loop {
        let mut j = 0.0;
        let ev = sim.step_until(500.0, &mut granular_edmd::observable::on_collision(|c: &Collision| j = c.impulse.normal()))?;
        match ev {
            Some(Event::WallCollision { wall, .. }) if wall == lid => {
                let (x,v) = p.at(sim.time());
                p = Piston { t0: sim.time(), x0: x, v0: v - j/mass, w };
                sim.set_boundary(make(p)?)?;
                hits += 1; xs += x; vs += mass*v*v;
            }
            Some(_) => {}
            None => break,
        }
    }
    println!("hits {hits} E0 {e0} E1 {} rel {:e}  <x> at hits {} M v^2 {} wall s {:.2} warnings {:?}", e(&sim,&p), e(&sim,&p)/e0-1.0, xs/hits as f64, vs/hits as f64, t.elapsed().as_secs_f64(), sim.warnings());
    println!("{:?}", sim.counters());
    Ok(())
}
