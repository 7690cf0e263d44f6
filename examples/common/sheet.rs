//! Panels on a sheet, and the sheet as a picture.

use kuva::backend::png::PngBackend;
use kuva::prelude::{Layout, Plot};
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};
use kuva::render::theme::Theme;

/// Colors of all pictures.
pub(crate) const INK: &str = "#22272e";
pub(crate) const QUIET: &str = "#6b7480";
pub(crate) const BLUE: &str = "#2c6fbb";
pub(crate) const ORANGE: &str = "#d9722e";
pub(crate) const GREEN: &str = "#3a8f6a";

/// A rectangle on the sheet, in its units; `y` points down.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

/// A picture made of panels.
pub(crate) struct Sheet {
    scene: Scene,
}

impl Sheet {
    /// Creates an empty sheet.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { scene: Scene::new(width, height) }
    }

    /// Adds a panel with the space that `margins` gives between its edge and its axes: left, right, top,
    /// bottom.
    pub(crate) fn panel(&mut self, place: Place, margins: [f64; 4], plots: Vec<Plot>, layout: Layout) {
        let [left, right, top, bottom] = margins;
        let grid = layout.show_grid;
        let layout = layout
            .with_width(place.width)
            .with_height(place.height)
            .with_force_margins(left, right)
            .with_force_margins_y(top, bottom)
            .with_theme(theme())
            .with_show_grid(grid)
            .with_label_size(13)
            .with_tick_size(11);
        let panel = render_multiple(plots, layout);
        self.scene.defs.extend(panel.defs);
        let transform = Some(format!("translate({},{})", place.x, place.y));
        self.scene.add(Primitive::GroupStart { transform, title: None, extra_attrs: None });
        panel.elements.into_iter().for_each(|element| self.scene.add(element));
        self.scene.add(Primitive::GroupEnd);
    }

    /// Adds a line of text that starts here.
    pub(crate) fn text(&mut self, x: f64, y: f64, size: u32, color: &str, content: &str) {
        self.scene.add(Primitive::Text {
            x,
            y,
            content: content.to_owned(),
            size,
            anchor: TextAnchor::Start,
            rotate: None,
            bold: false,
            color: Some(color.into()),
        });
    }

    /// Adds names in their colors, side by side from here.
    pub(crate) fn key(&mut self, x: f64, y: f64, names: &[(&str, &str)]) {
        let mut x = x;
        for (color, name) in names {
            self.text(x, y, 12, color, name);
            x += 7.5 * name.chars().count() as f64 + 16.0;
        }
    }

    /// Adds a disk about this place.
    pub(crate) fn disk(&mut self, x: f64, y: f64, radius: f64, color: &str) {
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
    pub(crate) fn line(&mut self, points: Vec<(f64, f64)>, color: &str, width: f64) {
        self.scene.add(Primitive::PolyLine {
            points,
            stroke: color.into(),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    /// Returns the picture as a PNG file, with this many pixels to a unit.
    pub(crate) fn png(&self, scale: f32) -> Result<Vec<u8>, String> {
        PngBackend::new().with_scale(scale).render_scene(&self.scene)
    }
}

/// Returns a layout whose axes have exactly these ranges.
pub(crate) fn axes(x: (f64, f64), y: (f64, f64)) -> Layout {
    let exact = Layout::new(x, y).with_x_axis_min(x.0).with_x_axis_max(x.1);
    exact.with_y_axis_min(y.0).with_y_axis_max(y.1)
}

fn theme() -> Theme {
    Theme {
        axis_color: QUIET.into(),
        tick_color: QUIET.into(),
        text_color: INK.into(),
        grid_color: "#e7eaee".into(),
        ..Theme::light()
    }
}

/// Returns a color from blue (-1) over light gray (0) to red (1).
pub(crate) fn diverging(value: f64) -> String {
    let (middle, blue, red) = ([214.0, 217.0, 221.0], [33.0, 102.0, 172.0], [178.0, 34.0, 48.0]);
    let end = if value < 0.0 { blue } else { red };
    let share = value.abs().min(1.0);
    let mix = |k: usize| (middle[k] + share * (end[k] - middle[k])) as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}
