//! The looks of series: colors, marks and dashes.
//!
//! Series differ by mark and dash as well as by color, so that a picture can also be read in gray, and by
//! color-blind readers.

use kuva::prelude::{LinePlot, LineStyle, Plot};
use kuva::render::render::{PathData, Primitive};

/// Colors of all pictures, by M. Okabe and K. Ito (2008): they differ for all kinds of color vision.
pub const INK: &str = "#1a1a1a";
pub const QUIET: &str = "#50565d";
pub const BLUE: &str = "#0072b2";
pub const VERMILION: &str = "#d55e00";
pub const GREEN: &str = "#009e73";
pub const PURPLE: &str = "#cc79a7";
pub const ORANGE: &str = "#e69f00";
pub const SKY: &str = "#56b4e9";

/// Colors of a quantity from low to high. They get lighter in steps, so that their order is visible in gray,
/// too.
pub const DARK_TO_LIGHT: [&str; 4] = ["#443983", "#2a788e", "#35b779", "#b5de2b"];

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    Disk,
    Square,
    Triangle,
    Diamond,
    TriangleDown,
    Cross,
}

/// The look of a series: its color, the dash of its line, and the shape of its marks.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    pub color: &'static str,
    /// Lengths of dashes and gaps, empty for a solid line; `None` for no line.
    pub dash: Option<&'static str>,
    pub width: f64,
    pub mark: Option<Mark>,
    /// Half the width of a mark.
    pub size: f64,
    /// Marks without a face.
    pub open: bool,
}

/// Looks of the series of a panel, in this order.
pub const LOOKS: [Look; 6] = [
    Look::new(BLUE, "", Mark::Disk),
    Look::new(VERMILION, "8 4", Mark::Square),
    Look::new(GREEN, "2 3", Mark::Triangle),
    Look::new(PURPLE, "9 3 2 3", Mark::Diamond),
    Look::new(ORANGE, "16 4", Mark::TriangleDown),
    Look::new(INK, "5 2", Mark::Cross),
];

impl Look {
    /// Creates the look of a series with line and marks.
    pub const fn new(color: &'static str, dash: &'static str, mark: Mark) -> Self {
        Self { color, dash: Some(dash), width: 2.0, mark: Some(mark), size: 4.5, open: false }
    }

    /// Creates the look of a line without marks.
    pub const fn line(color: &'static str, dash: &'static str) -> Self {
        Self { mark: None, ..Self::new(color, dash, Mark::Disk) }
    }

    /// Creates the look of marks without a line.
    pub const fn marks(color: &'static str, mark: Mark) -> Self {
        Self { dash: None, ..Self::new(color, "", mark) }
    }

    /// Returns the look of a series by its number. The looks repeat after the last.
    pub const fn number(number: usize) -> Self {
        LOOKS[number % LOOKS.len()]
    }

    /// Returns the same without marks.
    pub const fn without_marks(self) -> Self {
        Self { mark: None, ..self }
    }

    /// Returns the same without a line.
    pub const fn without_line(self) -> Self {
        Self { dash: None, ..self }
    }

    /// Returns the same with lines of this width.
    pub const fn with_width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Returns the same with marks of this half width.
    pub const fn with_size(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// Returns the same with marks that have no face.
    pub const fn open(self) -> Self {
        Self { open: true, ..self }
    }

    /// Returns a line through these points, for a panel.
    pub fn curve(&self, points: impl IntoIterator<Item = (f64, f64)>) -> Plot {
        let line = LinePlot::new().with_data(points).with_color(self.color).with_stroke_width(self.width);
        line.with_line_style(self.dash().map_or(LineStyle::Solid, LineStyle::Custom)).into()
    }

    /// Returns the dash of the line, or `None` for a solid line.
    pub fn dash(&self) -> Option<String> {
        self.dash.filter(|dash| !dash.is_empty()).map(str::to_owned)
    }

    /// Returns a mark about this place of a sheet. A white edge separates marks that touch each other.
    pub fn mark(&self, (x, y): (f64, f64)) -> Option<Primitive> {
        let mark = self.mark?;
        let size = self.size;
        // All shapes have about the same area.
        let corners: &[(f64, f64)] = match mark {
            Mark::Disk => {
                return Some(Primitive::Circle {
                    cx: x,
                    cy: y,
                    r: size,
                    fill: self.face().into(),
                    fill_opacity: None,
                    stroke: Some(self.edge().into()),
                    stroke_width: Some(self.edge_width()),
                });
            }
            Mark::Square => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            Mark::Triangle => &[(0.0, -1.25), (1.15, 0.8), (-1.15, 0.8)],
            Mark::TriangleDown => &[(0.0, 1.25), (1.15, -0.8), (-1.15, -0.8)],
            Mark::Diamond => &[(0.0, -1.3), (1.1, 0.0), (0.0, 1.3), (-1.1, 0.0)],
            Mark::Cross => &CROSS,
        };
        let corners =
            corners.iter().map(|(right, down)| format!("{:.2},{:.2}", x + size * right, y + size * down));
        Some(Primitive::Path(Box::new(PathData {
            d: format!("M{} Z", corners.collect::<Vec<_>>().join(" L")),
            fill: Some(self.face().into()),
            stroke: self.edge().into(),
            stroke_width: self.edge_width(),
            opacity: None,
            stroke_dasharray: None,
        })))
    }

    const fn face(&self) -> &'static str {
        if self.open { "white" } else { self.color }
    }

    const fn edge(&self) -> &'static str {
        if self.open { self.color } else { "white" }
    }

    const fn edge_width(&self) -> f64 {
        if self.open { 1.4 } else { 0.15 * self.size }
    }
}

/// Corners of a cross that stands on two feet.
const CROSS: [(f64, f64); 12] = [
    (0.0, -0.4),
    (0.7, -1.1),
    (1.1, -0.7),
    (0.4, 0.0),
    (1.1, 0.7),
    (0.7, 1.1),
    (0.0, 0.4),
    (-0.7, 1.1),
    (-1.1, 0.7),
    (-0.4, 0.0),
    (-1.1, -0.7),
    (-0.7, -1.1),
];

/// The look of noise in a legend.
pub const NOISE: Look = Look::line("#e1e3e5", "").with_width(10.0);

/// Returns a band of noise about zero, for a panel: places along it, and half its height there.
pub fn noise(edge: &[(f64, f64)]) -> Plot {
    let middle = LinePlot::new().with_data(edge.iter().map(|(x, _)| (*x, 0.0)));
    let middle = middle.with_color("#9aa0a6").with_stroke_width(0.8);
    middle.with_band(edge.iter().map(|(_, half)| -half), edge.iter().map(|(_, half)| *half)).into()
}

/// Returns a color from blue (-1) over light gray (0) to red (1).
pub fn diverging(value: f64) -> String {
    let (middle, blue, red) = ([214.0, 217.0, 221.0], [33.0, 102.0, 172.0], [178.0, 34.0, 48.0]);
    let end = if value < 0.0 { blue } else { red };
    let share = value.abs().min(1.0);
    let mix = |k: usize| (middle[k] + share * (end[k] - middle[k])) as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}
