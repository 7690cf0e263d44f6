//! Vessels in files.

use serde::{Deserialize, Serialize};

use super::{Container, Part, Vessel, VesselError};

/// A vessel as it stands in a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Vessel")]
pub(super) struct Record {
    container: Container,
    parts: Vec<(String, Part)>,
}

impl From<Vessel> for Record {
    fn from(vessel: Vessel) -> Self {
        let parts = vessel.parts.into_iter().map(|placed| (placed.name, placed.part)).collect();
        Self { container: vessel.container, parts }
    }
}

impl TryFrom<Record> for Vessel {
    type Error = VesselError;

    fn try_from(record: Record) -> Result<Self, VesselError> {
        let mut vessel = Self::new(record.container);
        for (name, part) in record.parts {
            vessel.put(name, part)?;
        }
        Ok(vessel)
    }
}
