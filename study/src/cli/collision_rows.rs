//! Collisions as lines of text.

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::Regime;
use granular_edmd::observable::Partner;
use granular_edmd::replay::Replayed;
use serde_json::{Value, json};

use crate::Scalar;
use crate::json::Object;

/// Names of the columns.
pub(super) const HEADINGS: &str = "number,time,disk,partner,wall,x,y,closing_speed,slip_speed,normal_impulse,\
                                   tangential_impulse,energy_change,regime";

fn cells(replayed: &Replayed, boundary: &impl Boundary) -> [Value; 13] {
    let Replayed { number, id, partner_id, collision: it, .. } = replayed;
    let wall = match it.partner {
        Partner::Wall(wall) => Some(boundary.wall_name(wall)),
        Partner::Disk(_) => None,
    };
    let (contact, impulse) = (&it.contact, &it.impulse);
    let regime = Some(impulse.regime()).filter(|regime| *regime != Regime::Unspecified);
    let [who, partner, wall] = [json!(id), json!(partner_id), json!(wall)];
    let regime = json!(regime.map(|regime| format!("{regime:?}")));
    let [x, y, time] = [it.position.x, it.position.y, it.time].map(Value::from);
    let speeds = [contact.closing_speed(), contact.slip_speed()].map(Value::from);
    let changes = [impulse.normal(), impulse.tangential(), it.energy_change].map(Value::from);
    let ([closing, slip], [normal, tangential, energy]) = (speeds, changes);
    [json!(number), time, who, partner, wall, x, y, closing, slip, normal, tangential, energy, regime]
}

/// Returns a collision as a row of a table, or as a JSON object.
pub(super) fn row(replayed: &Replayed, boundary: &impl Boundary, json: bool) -> String {
    let cells = cells(replayed, boundary);
    if json {
        let named = HEADINGS.split(',').zip(cells);
        return named.fold(Object::default(), |object, (name, cell)| object.with(name, cell)).line();
    }
    let text = |cell| match cell {
        Value::Null => String::new(),
        Value::String(text) => Scalar::Text(text).to_string(),
        number => number.to_string(),
    };
    cells.map(text).join(",")
}
