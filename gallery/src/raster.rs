//! Pictures as pixels: a PNG file from an SVG file.

use std::sync::Arc;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};

/// Returns a PNG file of an SVG file, with this many pixels to a unit.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, String> {
    let options = Options { fontdb: Arc::new(fonts()?), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or("the picture has no size")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("the picture is too large")?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}

/// Returns the fonts that kuva brings, so that letters look the same on all machines, and appear on those
/// without fonts. kuva gives them away only inside of a picture.
fn fonts() -> Result<Database, String> {
    let picture = SvgBackend::new().with_embedded_font(true).render_scene(&Scene::new(1.0, 1.0));
    let mut fonts = Database::new();
    for text in picture.split("base64,").skip(1) {
        let text = text.split('\'').next().unwrap_or_default();
        fonts.load_font_data(BASE64_STANDARD.decode(text).map_err(|error| error.to_string())?);
    }
    Ok(fonts)
}
