//! A sheet with panels, marks, legends and text: a picture, as SVG and as PNG.

use std::path::{Path, PathBuf};
use std::{fs, io};

use kuva::backend::svg::SvgBackend;
use kuva::prelude::{Layout, LinePlot, Plot};
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};

use crate::failure::named;
use crate::legend::Drawn;
use crate::look::{INK, Look, QUIET};
use crate::panel::{self, LARGE, MEDIUM, Margins, Panel, Place, SMALL};
use crate::raster;

/// Pixels of the PNG file to a unit of the sheet.
const PIXELS: f32 = 2.0;

/// Fonts of the letters. The PNG file has the first; a viewer of the SVG file takes the first that it finds.
const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

/// Distance of the lines of a legend, and length of its samples.
const LINE: f64 = 24.0;
const SAMPLE: f64 = 34.0;

/// Lengths of the ticks of logarithmic axes.
const LONG: f64 = 6.0;
const SHORT: f64 = 3.5;

/// A picture made of panels.
pub struct Sheet {
    scene: Scene,
    drawn: Drawn,
}

impl Sheet {
    /// Creates an empty sheet.
    pub fn new(width: f64, height: f64) -> Self {
        let mut scene = Scene::new(width, height);
        scene.font_family = Some(FONTS.into());
        scene.text_color = Some(INK.into());
        Self { scene, drawn: Drawn::default() }
    }

    /// Makes the sheet higher, and returns its previous height.
    pub const fn grow(&mut self, by: f64) -> f64 {
        let before = self.scene.height;
        self.scene.height += by;
        before
    }

    /// Adds a panel. The margins are the space between its edge and its axes: left, right, top, bottom.
    pub fn panel(&mut self, place: Place, margins: Margins, plots: Vec<Plot>, layout: Layout) -> Panel {
        let panel = Panel::new(place, margins, &layout);
        let name = layout.y_label.clone().filter(|_| layout.log_y);
        for plot in &plots {
            if let Plot::Line(line) = plot {
                let points = line.data.iter().map(|point| panel.at(panel.nearest((point.x, point.y))));
                self.drawn.add(&points.collect::<Vec<_>>());
            }
        }
        // Without any plot, kuva would draw no axes.
        let nothing = plots.is_empty().then(|| LinePlot::new().into());
        let plots = plots.into_iter().chain(nothing).collect();
        let drawn = render_multiple(plots, panel::styled(layout, place, margins));
        self.scene.defs.extend(drawn.defs);
        let transform = Some(format!("translate({},{})", place.x, place.y));
        self.scene.add(Primitive::GroupStart { transform, title: None, extra_attrs: None });
        drawn.elements.into_iter().for_each(|element| self.scene.add(element));
        self.scene.add(Primitive::GroupEnd);
        self.add_logarithmic_ticks(&panel);
        self.add_frame(&panel);
        // kuva leaves out the name of an axis without its own ticks.
        if let Some(name) = name {
            self.add_upright((place.x + 18.0, panel.middle()), &name);
        }
        panel
    }

    fn add_upright(&mut self, (x, y): (f64, f64), content: &str) {
        self.scene.add(Primitive::Text {
            x,
            y,
            content: content.to_owned(),
            size: MEDIUM,
            anchor: TextAnchor::Middle,
            rotate: Some(-90.0),
            bold: false,
            color: None,
        });
    }

    /// Adds the edges of a panel once more, over what was drawn in it.
    fn add_frame(&mut self, panel: &Panel) {
        let Place { x, y, width, height } = panel.place;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
        let edges = corners.map(|(right, down)| (x + right * width, y + down * height));
        self.line(edges.to_vec(), INK, 1.0);
    }

    fn add_logarithmic_ticks(&mut self, panel: &Panel) {
        let Place { x, y, width, height } = panel.place;
        let length = |long| if long { LONG } else { SHORT };
        let axis = panel.x;
        if axis.logarithmic {
            for (value, long) in axis.ticks() {
                let (at, length) = (panel.along(value), length(long));
                self.line(vec![(at, y), (at, y + length)], INK, 1.0);
                self.line(vec![(at, y + height), (at, y + height - length)], INK, 1.0);
                if long {
                    self.add_text(
                        (at, y + height + 20.0),
                        SMALL,
                        TextAnchor::Middle,
                        INK,
                        &axis.number(value),
                    );
                }
            }
        }
        let axis = panel.y;
        if axis.logarithmic {
            for (value, long) in axis.ticks() {
                let (at, length) = (panel.up(value), length(long));
                self.line(vec![(x, at), (x + length, at)], INK, 1.0);
                self.line(vec![(x + width, at), (x + width - length, at)], INK, 1.0);
                if long {
                    self.add_text((x - 6.0, at + 5.0), SMALL, TextAnchor::End, INK, &axis.number(value));
                }
            }
        }
    }

    /// Adds the marks of a series to a panel.
    pub fn marks(&mut self, panel: &Panel, look: Look, points: impl IntoIterator<Item = (f64, f64)>) {
        let held = points.into_iter().filter(|&point| panel.holds(point));
        for place in held.map(|point| panel.at(point)) {
            self.drawn.add(&[place]);
            self.mark(place, look);
        }
    }

    /// Adds a mark about this place of the sheet.
    pub fn mark(&mut self, place: (f64, f64), look: Look) {
        look.mark(place).into_iter().for_each(|mark| self.scene.add(mark));
    }

    /// Adds bars for errors to a panel, along or up, from one end to the other.
    pub fn bars(&mut self, panel: &Panel, look: Look, bars: impl IntoIterator<Item = [(f64, f64); 2]>) {
        for ends in bars {
            let [from, to] = ends.map(|end| panel.at(panel.nearest(end)));
            self.drawn.add(&[from, to]);
            self.line(vec![from, to], look.color, 1.0);
            // Caps across the ends: vertical ones for a horizontal bar.
            let cap = if from.1 == to.1 { (0.0, 3.0) } else { (3.0, 0.0) };
            for (x, y) in [from, to] {
                self.line(vec![(x - cap.0, y - cap.1), (x + cap.0, y + cap.1)], look.color, 1.0);
            }
        }
    }

    /// Adds the names of series in the first corner of a panel where they hide nothing that was drawn before,
    /// or below the sheet if there is none.
    pub fn legend_inside(&mut self, panel: &Panel, entries: &[(Look, &str)]) {
        // Single words may be wider than their number of letters suggests.
        let longest = entries.iter().map(|(_, name)| width(name, SMALL) + 12.0).fold(0.0, f64::max);
        let column = widest_sample(entries) + 8.0 + longest;
        let columns = self.drawn.free_corner(panel, (column, LINE), entries.len());
        let columns =
            columns.unwrap_or_else(|| vec![(panel.place.x, self.grow(LINE * entries.len() as f64 + 8.0))]);
        let rows = entries.len().div_ceil(columns.len()).max(1);
        for ((x, y), entries) in columns.into_iter().zip(entries.chunks(rows)) {
            self.legend((x, y + 17.0), entries);
        }
    }

    /// Adds the names of series, one below the other from here, with samples of their lines and marks.
    pub fn legend(&mut self, (x, y): (f64, f64), entries: &[(Look, &str)]) {
        let length = widest_sample(entries);
        for (row, (look, name)) in entries.iter().enumerate() {
            self.add_entry((x, y + LINE * row as f64), length, *look, name);
        }
    }

    /// Adds the names of series, side by side from here, with samples of their lines and marks.
    pub fn legend_in_row(&mut self, (x, y): (f64, f64), entries: &[(Look, &str)]) {
        let mut x = x;
        for (look, name) in entries {
            self.add_entry((x, y), sample(*look), *look, name);
            x += sample(*look) + width(name, SMALL) + 26.0;
        }
    }

    fn add_entry(&mut self, (x, y): (f64, f64), length: f64, look: Look, name: &str) {
        let middle = y - 5.0;
        if look.dash.is_some() {
            self.scene.add(Primitive::Line {
                x1: x,
                y1: middle,
                x2: x + length,
                y2: middle,
                stroke: look.color.into(),
                stroke_width: look.width,
                stroke_dasharray: look.dash(),
            });
        }
        self.mark((x + 0.5 * length, middle), look);
        self.text(x + length + 8.0, y, SMALL, INK, name);
    }

    /// Adds a line of text that starts here.
    pub fn text(&mut self, x: f64, y: f64, size: u32, color: &str, content: &str) {
        self.add_text((x, y), size, TextAnchor::Start, color, content);
    }

    /// Adds a line of text about here.
    pub fn centered(&mut self, place: (f64, f64), size: u32, color: &str, content: &str) {
        self.add_text(place, size, TextAnchor::Middle, color, content);
    }

    /// Adds a line of text about here, on white that hides the lines behind it.
    pub fn on_white(&mut self, (x, y): (f64, f64), size: u32, content: &str) {
        let (width, height) = (width(content, size) + 6.0, f64::from(size));
        self.scene.add(Primitive::Rect {
            x: x - 0.5 * width,
            y: y - 0.85 * height,
            width,
            height,
            fill: "white".into(),
            stroke: None,
            stroke_width: None,
            opacity: None,
        });
        self.centered((x, y), size, INK, content);
    }

    fn add_text(&mut self, (x, y): (f64, f64), size: u32, anchor: TextAnchor, color: &str, content: &str) {
        let (content, color) = (content.to_owned(), Some(color.into()));
        self.scene.add(Primitive::Text { x, y, content, size, anchor, rotate: None, bold: false, color });
    }

    /// Adds a title, and below it lines of small text, broken where they would leave the sheet. Returns the
    /// height of the last.
    pub fn header(&mut self, x: f64, title: &str, lines: &[&str]) -> f64 {
        self.text(x, 30.0, LARGE, INK, title);
        let (mut y, room) = (34.0, self.scene.width - x);
        for line in lines.iter().flat_map(|line| wrapped(line, room)) {
            y += 22.0;
            self.text(x, y, SMALL, QUIET, &line);
        }
        y
    }

    /// Adds a disk about this place.
    pub fn disk(&mut self, x: f64, y: f64, radius: f64, color: &str) {
        self.scene.add(Primitive::Circle {
            cx: x,
            cy: y,
            r: radius,
            fill: color.into(),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    /// Adds a line through these points.
    pub fn line(&mut self, points: Vec<(f64, f64)>, color: &str, width: f64) {
        let (stroke, stroke_dasharray) = (color.into(), None);
        self.scene.add(Primitive::PolyLine { points, stroke, stroke_width: width, stroke_dasharray });
    }

    /// Adds an arrow to the right of this length, and text behind it: the scale of the arrows of a panel.
    pub fn arrow(&mut self, (x, y): (f64, f64), length: f64, content: &str) {
        let (end, middle, head) = (x + length, y - 5.0, 6.0_f64.min(0.5 * length));
        self.line(vec![(x, middle), (end, middle)], INK, 1.6);
        self.line(
            vec![(end - head, middle - 0.6 * head), (end, middle), (end - head, middle + 0.6 * head)],
            INK,
            1.6,
        );
        self.text(end + 8.0, y, SMALL, INK, content);
    }

    /// Returns the picture as an SVG file.
    pub fn svg(&self) -> String {
        SvgBackend::new().with_pretty(true).render_scene(&self.scene)
    }

    /// Writes the picture as NAME.svg and NAME.png; a name may have dots in it.
    pub fn write(&self, name: &Path) -> io::Result<()> {
        let write = |ending: &str, bytes: &[u8]| {
            let path = PathBuf::from(format!("{}.{ending}", name.display()));
            named(&path, fs::write(&path, bytes))
        };
        write("svg", self.svg().as_bytes())?;
        let png = raster::png(&self.scene, PIXELS).map_err(io::Error::other)?;
        write("png", &png)
    }
}

/// Returns the length of the longest sample in a legend.
fn widest_sample(entries: &[(Look, &str)]) -> f64 {
    entries.iter().map(|(look, _)| sample(*look)).fold(0.0, f64::max)
}

/// Returns the length of a sample in a legend.
const fn sample(look: Look) -> f64 {
    if look.dash.is_some() { SAMPLE } else { 10.0 }
}

/// Breaks small text into lines of at most this width, but not within an equation.
pub fn wrapped(text: &str, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.replace(" = ", "\u{a0}=\u{a0}").split([' ', '\n']) {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), SMALL) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns about the width of a text.
fn width(text: &str, size: u32) -> f64 {
    0.55 * f64::from(size) * text.chars().count() as f64
}
