//! Letters as outlines, for pictures made of pixels.
//!
//! Labels are short and their scripts simple, so the letters are just placed one after another. A text shaper
//! for all languages would take as long to compile as all other code that draws.

use std::fmt::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The fonts of letters. Each letter comes from the first font that has it.
pub struct Letters {
    fonts: Vec<Vec<u8>>,
}

/// A line of text, with its place and its style.
struct Line<'a> {
    place: (f64, f64),
    content: &'a str,
    size: u32,
    anchor: TextAnchor,
    /// Turn in degrees, clockwise.
    turn: f64,
}

impl Letters {
    /// Returns the fonts that kuva contains, so that letters look the same on all machines, and appear on
    /// machines without fonts. kuva gives access to them only inside a picture.
    pub fn of_kuva() -> Result<Self, String> {
        let picture = SvgBackend::new().with_embedded_font(true).render_scene(&Scene::new(1.0, 1.0));
        let coded = picture.split("base64,").skip(1).map(|text| text.split('\'').next().unwrap_or_default());
        let fonts = coded.map(|text| BASE64_STANDARD.decode(text).map_err(|error| error.to_string()));
        Ok(Self { fonts: fonts.collect::<Result<_, _>>()? })
    }

    /// Returns a scene with outlines in place of its texts.
    pub fn outlined(&self, scene: &Scene) -> Result<Scene, String> {
        let faces = self.fonts.iter().map(|font| Face::parse(font, 0));
        let faces = faces.collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
        let mut outlined = Scene::new(scene.width, scene.height);
        outlined.elements.clone_from(&scene.elements);
        outlined.defs.clone_from(&scene.defs);
        outlined.background_color.clone_from(&scene.background_color);
        for element in &mut outlined.elements {
            let (line, color) = match element {
                Primitive::Text { x, y, content, size, anchor, rotate, color, .. } => {
                    let (place, turn) = ((*x, *y), rotate.unwrap_or_default());
                    (Line { place, content, size: *size, anchor: *anchor, turn }, color.clone())
                }
                _ => continue,
            };
            let color = color.or_else(|| scene.text_color.clone().map(Color::from));
            let path = PathData {
                d: line.outline(&faces),
                fill: Some(color.unwrap_or(Color::Rgb(0, 0, 0))),
                stroke: Color::None,
                stroke_width: 0.0,
                opacity: None,
                stroke_dasharray: None,
            };
            *element = Primitive::Path(Box::new(path));
        }
        Ok(outlined)
    }
}

impl Line<'_> {
    /// Returns the outlines of the letters as a path of SVG.
    fn outline(&self, faces: &[Face<'_>]) -> String {
        let letters: Vec<_> = self.content.chars().filter_map(|letter| glyph(faces, letter)).collect();
        let advance = |&(face, glyph): &(&Face<'_>, GlyphId)| {
            let units = f64::from(face.glyph_hor_advance(glyph).unwrap_or_default());
            units * self.scale(face)
        };
        let width: f64 = letters.iter().map(advance).sum();
        let mut right = match self.anchor {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => -0.5 * width,
            TextAnchor::End => -width,
        };
        let (sine, cosine) = self.turn.to_radians().sin_cos();
        let mut path = String::new();
        for letter in &letters {
            let (face, glyph) = *letter;
            let mut pen = Pen { path: &mut path, line: self, right, scale: self.scale(face), sine, cosine };
            face.outline_glyph(glyph, &mut pen);
            right += advance(letter);
        }
        path
    }

    fn scale(&self, face: &Face<'_>) -> f64 {
        f64::from(self.size) / f64::from(face.units_per_em())
    }
}

/// Returns a letter in the first font that has it, or the sign for a missing letter.
fn glyph<'a, 'b>(faces: &'a [Face<'b>], letter: char) -> Option<(&'a Face<'b>, GlyphId)> {
    let found = faces.iter().find_map(|face| Some((face, face.glyph_index(letter)?)));
    found.or_else(|| faces.first().map(|face| (face, GlyphId(0))))
}

/// Writes the outline of a letter as a path of SVG, at its place in the line.
struct Pen<'a> {
    path: &'a mut String,
    line: &'a Line<'a>,
    /// Distance from the place of the line to the letter.
    right: f64,
    scale: f64,
    sine: f64,
    cosine: f64,
}

impl Pen<'_> {
    /// Adds a command with the places of these points; fonts count upward, pictures downward.
    fn write<const N: usize>(&mut self, command: char, points: [(f32, f32); N]) {
        self.path.push(command);
        for (x, y) in points {
            let (x, y) = (self.right + self.scale * f64::from(x), -self.scale * f64::from(y));
            let (left, top) = self.line.place;
            let (x, y) = (left + self.cosine * x - self.sine * y, top + self.sine * x + self.cosine * y);
            // Writing to a string cannot fail.
            let _ = write!(self.path, "{x:.2} {y:.2} ");
        }
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.write('M', [(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.write('L', [(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.write('Q', [(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.write('C', [(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.path.push('Z');
    }
}
