//! Collisions as rows of a table.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::Regime;
use granular_edmd::observable::Partner;
use granular_edmd::replay::Replayed;

use crate::Scalar;

/// Names of the columns.
pub(super) const HEADINGS: &str = "number,time,disk,partner,wall,x,y,closing_speed,slip_speed,normal_impulse,\
                                   tangential_impulse,energy_change,regime";

/// Returns a collision as a row.
pub(super) fn row(replayed: &Replayed, boundary: &impl Boundary) -> String {
    let Replayed { number, id, partner_id, collision: it, .. } = replayed;
    let wall = match it.partner {
        Partner::Wall(wall) => boundary.wall_name(wall).to_string(),
        Partner::Disk(_) => String::new(),
    };
    let (contact, impulse) = (&it.contact, &it.impulse);
    let [x, y, time] = [it.position.x, it.position.y, it.time].map(Scalar::from);
    let speeds = [contact.closing_speed(), contact.slip_speed()];
    let changes = [impulse.normal(), impulse.tangential(), it.energy_change];
    let partner = partner_id.map_or_else(|| String::new().into(), Scalar::from);
    let regime = Some(impulse.regime()).filter(|regime| *regime != Regime::Unspecified);
    let regime = regime.map_or_else(String::new, |regime| format!("{regime:?}"));
    let cells = [(*number).into(), time, (*id).into(), partner, wall.into(), x, y].into_iter();
    let cells = cells.chain(speeds.into_iter().chain(changes).map(Scalar::from)).chain([regime.into()]);
    cells.map(|cell| cell.to_string()).collect::<Vec<_>>().join(",")
}
