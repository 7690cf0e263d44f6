use granular_edmd::collision::Frictional;
use granular_edmd::kinetic::{friction_of_largest_loss, mean_energy_change, Maxwellian};
use granular_edmd_study::{Axis, Control, Plan, Protocol, Study, vibrated_box::{Base, VibratedBox}};
fn main() -> anyhow::Result<()> {
    let (rule, gas) = (Frictional::from_inelasticity(0.05, 0.05, 0.0)?, Maxwellian::new(1.0)?);
    let k = friction_of_largest_loss(&rule, &gas).unwrap();
    println!("kappa at q=0.05: {k:.5}  <dE> {:.5}", mean_energy_change(&Frictional::from_inelasticity(0.05, 0.05, k)?, &gas));
    // Fig. 2 of the paper: 500 disks, no lid, thermal base. Cycle of a thermal base? Units of time, I guess.
    let boxed = VibratedBox::new(500, 25.0, Base::Thermal { temperature: 1.0, slip: false }).with_gravity(0.002).with_inelasticity(0.025).with_contact_duration(1e-4);
    let plan = Plan::new(boxed, Protocol::new(2000, 150, 40)?, 1)?.with_axis(Axis::new("friction", [0.05, 0.15, 0.3, 0.45, 0.8])?)?;
    let study = Study::open_or_create("out/out8", &plan)?;
    study.run(&Control::default())?;
    for p in study.points() { let p = p?; println!("{} Y {}", p.experiment().friction, p.mean(|s| s.height)); }
    Ok(())
}
