//! The meanings of a file's columns, whose names differ between programs.

/// A property of a disk to which a column can belong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Id,
    /// The number of a kind.
    Kind,
    /// The type of an atom, which LAMMPS counts from 1.
    Type,
    /// The name of a kind, which may be a number.
    Name,
    Position,
    /// Position in units of the box.
    Scaled,
    Unwrapped,
    UnwrappedScaled,
    Velocity,
    Momentum,
    Angle,
    /// A quaternion: x, y, z and w.
    Orientation,
    AngularVelocity,
    Radius,
    Diameter,
    Mass,
    /// Mass per area, or per volume of a sphere in files of LAMMPS.
    Density,
    InertiaFactor,
    Image,
}

/// A component of a quantity.
pub(super) type Slot = (Quantity, usize);

/// The names of each quantity, in lower case and without spaces, `_` and `-`.
const NAMES: [(Quantity, &str); 17] = {
    use Quantity as Q;
    [
        (Q::Id, "id identifier particleid particleidentifier atomid"),
        (Q::Kind, "kind"),
        (Q::Type, "type types particletype atomtype typeid"),
        (Q::Name, "species element name"),
        (Q::Position, "pos position positions points center centre"),
        (Q::Unwrapped, "unwrapped unwrappedposition"),
        (Q::Velocity, "velo vel velocity velocities v"),
        (Q::Momentum, "momenta momentum"),
        (Q::Angle, "angle"),
        (Q::Orientation, "orientation orientations"),
        (Q::AngularVelocity, "omega angularvelocity angularvelocities w"),
        (Q::Radius, "radius radii r rad"),
        (Q::Diameter, "diameter diameters d equivalentdiameter equivalentdiameterarea"),
        (Q::Mass, "mass masses m"),
        (Q::Density, "density densities"),
        (Q::InertiaFactor, "inertiafactor"),
        (Q::Image, "image images periodicimage mapshift i"),
    ]
};

impl Quantity {
    pub(super) const fn size(self) -> usize {
        match self {
            Self::Position
            | Self::Scaled
            | Self::Unwrapped
            | Self::UnwrappedScaled
            | Self::Velocity
            | Self::Momentum
            | Self::AngularVelocity
            | Self::Image => 3,
            Self::Orientation => 4,
            _ => 1,
        }
    }

    pub(super) fn named(name: &str) -> Option<Self> {
        let known = NAMES.iter().find(|(_, names)| names.split(' ').any(|known| known == name));
        known.map(|(quantity, _)| *quantity)
    }

    /// Returns the slot of a component.
    pub(super) fn slot(self, component: usize) -> Option<Slot> {
        (component < self.size()).then_some((self, component))
    }
}

/// A column of a file.
#[derive(Debug, Clone)]
pub(super) struct Column {
    /// The name in the file.
    pub(super) name: String,
    /// The component of a disk's properties, if the column has one.
    pub(super) slot: Option<Slot>,
}

impl Column {
    /// Returns the columns for a name with this number of components.
    pub(super) fn of(name: &str, count: usize) -> impl Iterator<Item = Self> {
        let plain = plain(name);
        let name = Some(name.trim().trim_matches('"')).filter(|name| !name.is_empty());
        (0..count).map(move |component| {
            let slot = if count == 1 { single(&plain) } else { vector(&plain, component, count) };
            Self { name: name.unwrap_or("(without a name)").to_owned(), slot }
        })
    }
}

/// Returns a name in lower case, without quotes and without what divides its words.
pub(super) fn plain(name: &str) -> String {
    name.to_lowercase().replace([' ', '_', '-', '"'], "")
}

/// Names of columns that number the frames of a table, and of columns of their times.
pub(super) const FRAMES: &str = "frame frames framenumber frameid step timestep slice";
pub(super) const TIMES: &str = "time times t seconds positiont";

/// Units that may follow a name after `_` or `/`.
const UNITS: [&str; 10] = ["um", "µm", "micron", "microns", "mm", "cm", "m", "px", "pixel", "pixels"];

/// Divides the heading of a column into its name and its unit, which is empty if there is none.
pub(super) fn name_and_unit(heading: &str) -> (&str, &str) {
    let inner = heading.strip_suffix([']', ')', '}']).and_then(|text| text.rsplit_once(['[', '(', '{']));
    let after = heading.rsplit_once(['_', '/']).filter(|(_, unit)| UNITS.contains(unit));
    // A number or an axis in brackets is a component.
    let is_component = |unit: &str| unit.parse::<usize>().is_ok() || ["x", "y", "z", "w"].contains(&unit);
    match inner.or(after) {
        Some((name, unit)) if !is_component(unit) => (name.trim(), unit),
        _ => (heading, ""),
    }
}

/// Settles what depends on the other columns: numbers of particles, and what programs that track particles
/// call mass and angle. Returns notes about it.
pub(super) fn settle(columns: &mut [Column]) -> Vec<String> {
    let names: Vec<String> = columns.iter().map(|column| plain(&column.name)).collect();
    let has = |known: &[&str]| names.iter().any(|name| known.contains(&name.as_str()));
    let has_spots = has(&["ecc", "signal", "rawmass"]);
    let has_shapes = has(&["major", "minor", "feret"]);
    let has_id = columns.iter().any(|column| column.slot == Quantity::Id.slot(0));
    let mut notes = Vec::new();
    if has_spots || has_shapes || has(&["centroid0"]) {
        notes.push("y points down in images, and up here: the disks are mirrored".to_owned());
    }
    for (column, name) in columns.iter_mut().zip(&names) {
        let found = match name.as_str() {
            "mass" if has_spots => "the brightness of a spot here, and ignored",
            "angle" if has_shapes => "in degrees here, and ignored",
            "d" if column.name == "D" => "read as the diameter",
            "particle" | "track" | "trackid" if !has_id => {
                column.slot = Quantity::Id.slot(0);
                continue;
            }
            _ => continue,
        };
        if found.ends_with("ignored") {
            column.slot = None;
        }
        notes.push(format!("`{}` is {found}", column.name));
    }
    notes
}

/// Returns the slot of a column with a separate name, such as `radius`, `xs` or `velocity.x`.
fn single(name: &str) -> Option<Slot> {
    let axis = |letter: char| "xyzw".find(letter);
    let mut letters = name.chars();
    if let Some(component) = letters.next().and_then(axis) {
        let quantity = match letters.as_str() {
            "" => Some(Quantity::Position),
            "s" => Some(Quantity::Scaled),
            "u" => Some(Quantity::Unwrapped),
            "su" => Some(Quantity::UnwrappedScaled),
            _ => None,
        };
        if let Some(quantity) = quantity {
            return quantity.slot(component);
        }
    }
    match name {
        "cx" | "centroid1" => return Quantity::Position.slot(0),
        "cy" | "centroid0" => return Quantity::Position.slot(1),
        _ => {}
    }
    match Quantity::named(name) {
        Some(Quantity::Orientation) => return Quantity::Angle.slot(0),
        Some(Quantity::AngularVelocity) => return Quantity::AngularVelocity.slot(2),
        Some(quantity) if quantity.size() == 1 => return quantity.slot(0),
        Some(_) => return None,
        None => {}
    }
    let name = name.trim_end_matches(']');
    let last = name.chars().next_back()?;
    let stem = &name[..name.len() - last.len_utf8()];
    let bare = stem.trim_end_matches(['.', ':', '[']);
    let digit = last.to_digit(10).filter(|_| bare != stem).map(|digit| digit as usize);
    let quantity = Quantity::named(bare).filter(|quantity| quantity.size() > 1)?;
    quantity.slot(axis(last).or(digit)?)
}

/// Returns the slot of one of several components.
fn vector(name: &str, component: usize, count: usize) -> Option<Slot> {
    let quantity = Quantity::named(name)?;
    let is_whole = match quantity {
        Quantity::Orientation | Quantity::AngularVelocity => count == quantity.size(),
        _ => (2..=quantity.size()).contains(&count),
    };
    quantity.slot(component).filter(|_| is_whole)
}
