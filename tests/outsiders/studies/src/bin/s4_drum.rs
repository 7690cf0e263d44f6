//! A round container whose wall swings: angular velocity W cos(w t). Own boundary.
use granular_edmd::prelude::*;
use granular_edmd::{Fingerprint, Flight};
use granular_edmd::observable::Partner;
use granular_edmd::boundary::{Brick, Domain, FirstTouch, Overlap, Probe, Surface, Touch, WallView, laws};
#[derive(Clone)]
struct Drum { r: f64, rim: Brick, spin: f64, w: f64, origin: f64, forget: u8 }
impl Drum { fn new(r: f64, spin: f64, w: f64, forget: u8) -> anyhow::Result<Self> { Ok(Self { r, rim: Brick::circle(DVec2::ZERO, r)?, spin, w, origin: 0.0, forget }) } }
impl Boundary for Drum {
    fn domain(&self) -> Domain { Domain::new(-self.r, self.r, -self.r, self.r) }
    fn wall_count(&self) -> usize { 1 }
    fn wall(&self, _: usize, _: f64) -> WallView<'_> { WallView::new("rim") }
    fn set_time_origin(&mut self, o: f64) { if self.forget != 1 { self.origin = o.rem_euclid(std::f64::consts::TAU/self.w); } }
    fn may_touch(&self, region: &Region, radius: f64) -> bool { self.rim.may_touch(region, radius) }
    fn first_touch(&self, f: &Flight, until: f64) -> FirstTouch<Touch> { self.rim.first_touch(f, until).map(|t| Touch::new(t, 0)).into() }
    fn surface(&self, _: usize, x: DVec2, t: f64) -> Surface<'_> {
        let n = self.rim.normal(x);
        let spin = self.spin * libm::cos(self.w*(t+self.origin));
        let v = if self.forget == 2 { spin*self.r*n.perp() + 0.3*n } else { -spin*self.r*n.perp() };
        let s = Surface::new(n, v);
        if self.forget == 3 { s } else { s.with_radius(-self.r) }
    }
    fn overlap(&self, p: &Probe) -> Option<Overlap> { let d = p.radius() - self.rim.signed_distance(p.position()); (d > 0.0).then_some(Overlap::new(0, d)) }
    fn fingerprint(&self) -> Option<Fingerprint> { Some(Fingerprint::of("swing").number(self.r).number(self.spin).number(self.w)) }
}
fn main() -> anyhow::Result<()> {
    for forget in 0..4 { let mut d = Drum::new(10.0, 0.3, 2.0, forget)?; println!("fault {forget}: laws {:?}", laws::check(&mut d, 0.5, 1.0, 1).map_err(|e| e.to_string())); }
    let rule = Frictional::from_inelasticity(0.05, 0.05, 0.5)?;
    for forget in 0..4 {
        let d = Drum::new(10.0, 0.3, 0.0001, 0)?; let mut d = Drum { forget, ..d }; d.w = 0.05;
        let disks = initial::with_maxwellian_velocities(initial::scattered(&d, 120, 0.5, 20.0, 1)?, 1.0, 1)?;
        let mut sim = Simulation::builder(rule, d).disks(disks).build()?;
        // Torque of the wall against the change of the angular momentum of the disks.
        let l = |s: &[Disk]| s.iter().map(|d| d.mass()*d.position().perp_dot(d.velocity()) + d.moment_of_inertia()*d.angular_velocity()).sum::<f64>();
        let l0 = l(&sim.disks());
        let mut jl = 0.0; let mut n = 0u64;
        let mut obs = granular_edmd::observable::on_collision(|c: &Collision| if let Partner::Wall(_) = c.partner { n += 1; jl += c.impulse.tangential(); });
        let end = sim.run_until(2000.0, &mut obs);
        let _ = obs;
        let dl = l(&sim.disks()) - l0;
        println!("fault {forget}: {:?} dL {dl:.6}  sum tangential*R {:.6} hits {n} E {:?} warn {:?}", end.map_err(|e| e.to_string()), jl*10.0, sim.measure(&Energies).translational, sim.warnings());
    }
    Ok(())
}
