//! A movie of a run: one convection roll turns.
//!
//! 1000 disks in the paper's vibrated box. They are colored by their height once the roll turns, to show how
//! the roll carries them around. The movie is an animated PNG, which browsers show.
//!
//! ```text
//! cargo run --release -p gallery --bin movie
//! cargo run --release -p gallery --bin movie -- --friction 0.08 --frames 100 --out two_rolls
//! ```
//!
//! The example writes `movie.png`, and with `--json` the mean height of each layer over time.

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::prelude::*;
use granular_edmd::statistics::RunningMean;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use gallery::command_line::{self, Failure, non_negative, positive, whole};
use gallery::failure::named;
use gallery::progress::Progress;
use gallery::results::Results;

/// A movie of disks in a vibrated box.
#[derive(Parser)]
struct Arguments {
    /// Friction: one roll turns at 0.03, two at 0.08.
    #[arg(long, default_value_t = 0.03, value_parser = non_negative)]
    friction: f64,
    /// Number of frames.
    #[arg(long, default_value_t = 60, value_parser = whole::<10_000>)]
    frames: u64,
    /// Oscillations between two frames.
    #[arg(long, default_value_t = 8, value_parser = whole::<10_000>)]
    oscillations: u64,
    /// Oscillations before the first frame, in which the roll begins to turn.
    #[arg(long, default_value_t = 1500, value_parser = whole::<1_000_000>)]
    settle: u64,
    /// Pixels for a diameter of a disk.
    #[arg(long, default_value_t = 3.0, value_parser = positive)]
    pixels: f64,
    /// Seed of the initial velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Records at most 5 frames, after at most 20 oscillations.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// Width and height of the box, and the part of the height that is shown.
const BOX: DVec2 = DVec2::new(60.0, 150.0);
const SEEN: f64 = 120.0;

/// Colors of the layers, from below, and of the walls.
const LAYERS: [[u8; 3]; 5] = [[49, 54, 149], [116, 173, 209], [120, 120, 120], [253, 174, 97], [165, 0, 38]];
const WALL: [u8; 3] = [34, 39, 46];
const PAPER: [u8; 3] = [255, 255, 255];

/// Shades of a color between paper and the color itself, so that edges are smooth.
const SHADES: u8 = 4;

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let path = arguments.results.path("movie.png");
    let frames = frames(arguments).map_err(Failure::run)?;
    write(&path, &frames).map_err(Failure::run)?;
    let size = path.metadata().map_err(Failure::run)?.len();
    gallery::say!("wrote {}: {} frames, {} kB", path.display(), frames.len(), size / 1000);
    let numbers =
        |frame: &Frame| serde_json::json!({ "time": frame.time, "heights_of_layers": frame.heights });
    arguments.results.write_json(&frames.iter().map(numbers).collect()).map_err(Failure::run)
}

/// A frame of the movie: its time, the mean heights of the layers, and the picture.
struct Frame {
    time: f64,
    heights: [f64; LAYERS.len()],
    canvas: Canvas,
}

/// Runs the box, and returns the frames.
fn frames(arguments: &Arguments) -> Result<Vec<Frame>, Box<dyn Error>> {
    let oscillation = TAU / 10.0;
    let container =
        Container::closed(BOX.x, BOX.y)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let disks = initial::lattice(&container, 1000, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.5, arguments.seed)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.0, 0.0, arguments.friction)?, 1e-4)?;
    let mut run = Simulation::builder(rule, container).disks(disks).gravity(0.015_625).build()?;
    let quick = |value: u64, most: u64| if arguments.quick { value.min(most) } else { value };
    let (settle, count) = (quick(arguments.settle, 20), quick(arguments.frames, 5));
    let interval = arguments.oscillations as f64 * oscillation;
    let start = settle as f64 * oscillation;
    let end = start + (count - 1) as f64 * interval;
    let mut progress = Progress::of("run").until(end);
    run.run_until(start, &mut progress)?;
    let (layers, mut frames) = (layers(&run.disks()), Vec::new());
    let mut camera =
        on_sample(SampleTimes::every(interval)?.starting_at(start)?, |snapshot: &Snapshot<'_>| {
            let heights = heights(snapshot.disks(), &layers);
            let canvas = Canvas::of(snapshot.disks(), &layers, arguments.pixels);
            frames.push(Frame { time: snapshot.time(), heights, canvas });
        });
    run.run_until(end, &mut (&mut camera, &mut progress))?;
    gallery::output::warn(&run.warnings());
    Ok(frames)
}

/// Returns the layer of each disk by its height. All layers have the same number of disks.
fn layers(disks: &[Disk]) -> Vec<u8> {
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by(|&a, &b| disks[a].position().y.total_cmp(&disks[b].position().y));
    let mut layers = vec![0; disks.len()];
    for (place, disk) in order.into_iter().enumerate() {
        layers[disk] = (place * LAYERS.len() / disks.len()) as u8;
    }
    layers
}

/// Returns the mean height of the disks in each layer.
fn heights(disks: &[Disk], layers: &[u8]) -> [f64; LAYERS.len()] {
    std::array::from_fn(|layer| {
        let of_layer = disks.iter().zip(layers).filter(|&(_, &of)| usize::from(of) == layer);
        of_layer.map(|(disk, _)| disk.position().y).collect::<RunningMean>().mean()
    })
}

/// A picture of palette colors: 0 is paper, 1 the walls, and the numbers from 2 up are the shades of each
/// layer.
struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Canvas {
    /// Draws disks in the colors of their layers, with this number of pixels per unit of length.
    fn of(disks: &[Disk], layers: &[u8], scale: f64) -> Self {
        let (width, height) = ((scale * BOX.x).ceil() as usize + 2, (scale * SEEN).ceil() as usize + 1);
        let mut canvas = Self { width, height, pixels: vec![0; width * height] };
        for (disk, &layer) in disks.iter().zip(layers) {
            canvas.disk(scale * disk.position(), scale * disk.radius(), layer);
        }
        canvas.walls();
        canvas
    }

    fn disk(&mut self, center: DVec2, radius: f64, layer: u8) {
        let around = |middle: f64, end: usize| {
            let (first, last) = (middle - radius - 1.0, middle + radius + 2.0);
            (first.max(0.0) as usize)..(last.max(0.0) as usize).min(end)
        };
        for row in around(center.y, self.height - 1) {
            for column in around(center.x, self.width - 2) {
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let share = (radius + 0.5 - middle.distance(center)).clamp(0.0, 1.0);
                let shade = (share * f64::from(SHADES)).round() as u8;
                if shade > 0 {
                    let pixel = (self.height - 2 - row) * self.width + column + 1;
                    self.pixels[pixel] = 1 + layer * SHADES + shade;
                }
            }
        }
    }

    /// Draws the walls at the sides and the floor.
    fn walls(&mut self) {
        for row in self.pixels.chunks_mut(self.width) {
            row[0] = 1;
            row[self.width - 1] = 1;
        }
        self.pixels[(self.height - 1) * self.width..].fill(1);
    }
}

/// Returns the colors of the palette.
fn palette() -> Vec<u8> {
    let mix = |color: [u8; 3], shade: u8| {
        std::array::from_fn(|k| {
            let (paper, ink) = (f64::from(PAPER[k]), f64::from(color[k]));
            (paper + (ink - paper) * f64::from(shade) / f64::from(SHADES)).round() as u8
        })
    };
    let shades = LAYERS.iter().flat_map(|&color| (1..=SHADES).map(move |shade| mix(color, shade)));
    [PAPER, WALL].into_iter().chain(shades).flatten().collect()
}

/// Writes the movie, an endless loop at twelve frames per second.
fn write(path: &Path, frames: &[Frame]) -> Result<(), Box<dyn Error>> {
    let first = &frames.first().ok_or("there are no frames")?.canvas;
    let file = BufWriter::new(named(path, File::create(path))?);
    let mut encoder = Encoder::new(file, first.width as u32, first.height as u32);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(palette());
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(1, 12)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(&frame.canvas.pixels)?;
    }
    writer.finish()?;
    Ok(())
}
