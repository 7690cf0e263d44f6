//! A study of a drum, a rule and a driving that the library does not know.

use downstream::drum::Drum;
use downstream::viscoelastic::Viscoelastic;
use granular_edmd::observable::{Observer, SampleTimes, Snapshot};
use granular_edmd::simulation::Driving;
use granular_edmd::{Disk, Fingerprint, Gravity, ParameterError, initial};
use granular_edmd_files::{ExtendedXyz, Recorder};
use granular_edmd_study::{
    Axis, Column, Control, Experiment, ExperimentError, Plan, Protocol, SavedDriving, Start, Study,
};
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tumbling {
    disks: usize,
    loss: f64,
    spin: f64,
}

/// Air that slows all grains.
#[derive(Debug, Serialize, Deserialize)]
struct Air(SampleTimes);

impl Driving for Air {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.0
    }
    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        for disk in disks {
            *disk = disk.with_velocity(0.99 * disk.velocity())?;
        }
        Ok(())
    }
}

impl Experiment for Tumbling {
    type Rule = Viscoelastic;
    type Boundary = Drum;
    type Observer = ();
    type Sample = f64;

    fn revision() -> Fingerprint {
        Fingerprint::of(include_str!("study.rs"))
    }
    fn rule(&self) -> Result<Viscoelastic, ExperimentError> {
        Ok(Viscoelastic::new(self.loss, 0.3)?)
    }
    fn boundary(&self) -> Result<Drum, ExperimentError> {
        Ok(Drum::new(5.0)?.turning(self.spin).with_rule(self.rule()?))
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        Ok(initial::scattered(&self.boundary()?, self.disks, 0.3, 10.0, seed)?)
    }
    fn gravity(&self) -> Gravity {
        0.1.into()
    }
    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
        snapshot.mean(Disk::translational_energy)
    }
    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("energy", "energy", |energy| *energy)]
    }
    fn driving(&self, _seed: u64) -> Result<Option<Box<dyn SavedDriving>>, ExperimentError> {
        Ok(Some(Box::new(Air(SampleTimes::every(0.5)?))))
    }
    fn companion(&self, start: &Start<'_>) -> Result<Option<Box<dyn Observer>>, ExperimentError> {
        let path = start.folder.join(format!("{}-{}.xyz", start.ramp, start.value));
        let recorder = Recorder::create_or_append(path, ExtendedXyz, SampleTimes::every(2.0)?);
        Ok(Some(Box::new(recorder.map_err(ExperimentError::new)?)))
    }
}

#[test]
fn a_stranger_s_study_is_run_read_and_recorded() -> Result<(), ExperimentError> {
    let folder = std::env::temp_dir().join(format!("granular-edmd-stranger-{}", std::process::id()));
    let plan = Plan::new(Tumbling { disks: 15, loss: 0.1, spin: 0.5 }, Protocol::new(2, 4, 1)?, 1)?;
    let plan = plan.with_axis(Axis::new("spin", [0.0, 2.0])?)?;
    let study = Study::open_or_create(&folder, &plan)?;
    assert!(study.run(&Control::default())?.is_complete());
    let energy = |ramp| study.record(ramp, 0).unwrap().unwrap().mean(|energy| *energy).mean();
    assert!(energy(0) > 0.0 && energy(1) != energy(0), "the drum acts: {} {}", energy(0), energy(1));
    let frames = std::fs::read_to_string(folder.join("1-0.xyz"))?;
    assert_eq!(frames.matches("Lattice=").count(), 3);
    assert!(std::fs::read_to_string(folder.join("values.csv"))?.starts_with("ramp,value,leg,spin,seed,"));
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}
