//! Pictures as pixels: a PNG file of a scene.

use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::letters::Letters;
use crate::palette::Palette;

/// Returns a PNG file of a scene, with `scale` pixels per unit, on white, in at most 256 colors.
pub fn png(scene: &Scene, scale: f32) -> Result<Vec<u8>, String> {
    let scene = Letters::of_kuva()?.outlined(scene)?;
    let svg = SvgBackend::new().render_scene(&scene);
    let tree = Tree::from_str(&svg, &Options::default()).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or("the picture has no size")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("the picture is too large")?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    // The picture is opaque everywhere, so its colors need no conversion.
    let colors: Vec<_> =
        pixels.pixels().iter().map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    file(size.width(), size.height(), &colors).map_err(|error| error.to_string())
}

/// Returns a PNG file of these colors with a palette. It has a third of the bytes of a file that holds the
/// color of each pixel.
fn file(width: u32, height: u32, colors: &[[u8; 3]]) -> Result<Vec<u8>, png::EncodingError> {
    let palette = Palette::of(colors);
    let indices: Vec<u8> = colors.iter().map(|&color| palette.index(color)).collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.bytes());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header()?.write_image_data(&indices)?;
    Ok(file)
}
