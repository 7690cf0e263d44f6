//! Panels: their places on a sheet, and their axes.

use kuva::prelude::{Layout, TickAlign, TickPos};
use kuva::render::theme::Theme;

use crate::look::INK;

/// Sizes of letters: notes and numbers at ticks, names of axes and series, and the title.
pub const SMALL: u32 = 16;
pub const MEDIUM: u32 = 18;
pub const LARGE: u32 = 20;

/// Width of a picture for one column of a page. Printed 8 cm wide, its small letters are 7 points high.
pub const COLUMN: f64 = 500.0;

/// A rectangle on the sheet, in its units; `y` points down.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

/// Space between a panel's edge and its axes: left, right, top, bottom.
pub type Margins = [f64; 4];

/// An axis of a panel: its range, and the kind of its scale.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    range: (f64, f64),
    pub logarithmic: bool,
}

impl Axis {
    /// Returns the position of a value between the ends, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        if self.logarithmic { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
    }

    /// Returns the ticks of a logarithmic axis, and for each whether it is long and has a number.
    pub fn ticks(&self) -> Vec<(f64, bool)> {
        let (low, high) = self.range;
        // An axis shorter than a decade and a half has numbers at 2 and 5, too.
        let short = high / low < 30.0;
        let long = |k| k == 1 || (short && (k == 2 || k == 5));
        let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
        // Division gives exactly 0.001; a product with 1e-3 would not.
        let at = |k, decade: i32| f64::from(k) * 10f64.powi(decade.max(0)) / 10f64.powi((-decade).max(0));
        let ticks = decades.flat_map(|decade| (1..10).map(move |k| (at(k, decade), long(k))));
        ticks.filter(|(tick, _)| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(tick)).collect()
    }

    /// Formats a number at a tick: as people write it, or as a power of ten if the axis has very small or
    /// very large numbers.
    pub fn number(&self, value: f64) -> String {
        let (low, high) = self.range;
        if low >= 1e-4 && high <= 1e5 {
            return value.to_string();
        }
        let digits: Vec<char> = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().collect();
        let power = format!("{:.0}", value.log10());
        let raised = power.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]));
        format!("10{}", raised.collect::<String>())
    }
}

/// A panel on a sheet: the place inside of its axes, and their ranges.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    pub place: Place,
    pub x: Axis,
    pub y: Axis,
}

impl Panel {
    pub const fn new(place: Place, margins: Margins, layout: &Layout) -> Self {
        let [left, right, top, bottom] = margins;
        let place = Place {
            x: place.x + left,
            y: place.y + top,
            width: place.width - left - right,
            height: place.height - top - bottom,
        };
        Self {
            place,
            x: Axis { range: layout.x_range, logarithmic: layout.log_x },
            y: Axis { range: layout.y_range, logarithmic: layout.log_y },
        }
    }

    /// Returns the position of a point on the sheet.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let Place { x: left, y: top, width, height } = self.place;
        (left + width * self.x.share(x), top + height * (1.0 - self.y.share(y)))
    }

    /// Returns the position of a value on the horizontal axis.
    pub fn along(&self, value: f64) -> f64 {
        self.at((value, self.y.range.0)).0
    }

    /// Returns the position of a value on the vertical axis.
    pub fn up(&self, value: f64) -> f64 {
        self.at((self.x.range.0, value)).1
    }

    /// Returns the height of the middle.
    pub const fn middle(&self) -> f64 {
        self.place.y + 0.5 * self.place.height
    }

    /// Returns the point within the axes that is nearest.
    pub fn nearest(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x.clamp(self.x.range.0, self.x.range.1), y.clamp(self.y.range.0, self.y.range.1))
    }

    /// Returns whether a point is within the axes.
    pub fn holds(&self, (x, y): (f64, f64)) -> bool {
        let within = |share: f64| (-1e-9..=1.0 + 1e-9).contains(&share);
        within(self.x.share(x)) && within(self.y.share(y))
    }
}

/// Returns a layout whose axes have exactly these ranges.
pub fn axes(x: (f64, f64), y: (f64, f64)) -> Layout {
    let exact = Layout::new(x, y).with_x_axis_min(x.0).with_x_axis_max(x.1);
    exact.with_y_axis_min(y.0).with_y_axis_max(y.1).with_tick_align(TickAlign::Inside)
}

/// Returns the smallest and the largest of the values that are finite.
pub fn ends(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Gives a layout the size of its panel, and the style of all panels.
pub fn styled(layout: Layout, place: Place, margins: Margins) -> Layout {
    let [left, right, top, bottom] = margins;
    let both = matches!(layout.tick_align, TickAlign::Inside);
    let mut layout = layout
        .with_tick_pos(if both { TickPos::Both } else { TickPos::Primary })
        .with_width(place.width)
        .with_height(place.height)
        .with_force_margins(left, right)
        .with_force_margins_y(top, bottom)
        .with_theme(theme())
        .with_show_grid(false)
        .with_box_axes()
        .with_label_size(MEDIUM)
        .with_tick_size(SMALL);
    // The ticks of logarithmic axes are our own: a number at each power of ten, and short ticks between them.
    layout.suppress_x_ticks |= layout.log_x;
    layout.suppress_y_ticks |= layout.log_y;
    layout
}

fn theme() -> Theme {
    Theme { axis_color: INK.into(), tick_color: INK.into(), text_color: INK.into(), ..Theme::light() }
}
