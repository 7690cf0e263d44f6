//! A palette of few colors for a picture of many.

use std::collections::BTreeMap;

/// Largest number of colors in a palette.
const MOST: usize = 256;

type Color = [u8; 3];

/// At most 256 colors and, for each color of a picture, the palette color that replaces it.
pub struct Palette {
    colors: Vec<Color>,
    index: BTreeMap<Color, u8>,
}

impl Palette {
    /// Chooses the palette of a picture by median cut: the group with the widest spread of its pixels is cut
    /// in two halves, until there are enough groups.
    pub fn of(pixels: &[Color]) -> Self {
        let mut counts = BTreeMap::<Color, u64>::new();
        for &color in pixels {
            *counts.entry(color).or_default() += 1;
        }
        let mut groups = vec![Group::of(counts.into_iter().collect())];
        while groups.len() < MOST {
            let widest = (0..groups.len()).max_by_key(|&k| (groups[k].weight, k));
            let Some(widest) = widest.filter(|&k| groups[k].weight > 0) else { break };
            let [first, second] = groups.swap_remove(widest).halves();
            groups.extend([first, second]);
        }
        let of_group = |(k, group): (usize, &Group)| {
            group.colors.iter().map(move |&(color, _)| (color, k as u8)).collect::<Vec<_>>()
        };
        let index = groups.iter().enumerate().flat_map(of_group).collect();
        Self { colors: groups.iter().map(Group::color).collect(), index }
    }

    /// Returns the number of the palette color that replaces this color of the picture.
    pub fn index(&self, color: Color) -> u8 {
        self.index.get(&color).copied().unwrap_or_default()
    }

    /// Returns red, green and blue of all colors, one after the other.
    pub fn bytes(&self) -> Vec<u8> {
        self.colors.concat()
    }
}

/// Colors that one palette color will replace, and the number of pixels of each.
struct Group {
    colors: Vec<(Color, u64)>,
    channel: usize,
    /// The gain of cutting this group: its spread times the root of its pixels; 0 for a single color.
    weight: u64,
}

impl Group {
    fn of(colors: Vec<(Color, u64)>) -> Self {
        let spread = |channel: usize| {
            let of_channel = || colors.iter().map(|(color, _)| color[channel]);
            of_channel().max().unwrap_or(0) - of_channel().min().unwrap_or(0)
        };
        let channel = (0..3).max_by_key(|&channel| spread(channel)).unwrap_or(0);
        let pixels: u64 = colors.iter().map(|(_, count)| count).sum();
        let weight = u64::from(spread(channel)) * (pixels as f64).sqrt().ceil() as u64;
        Self { colors, channel, weight }
    }

    /// Cuts the group where half of its pixels are on either side.
    fn halves(mut self) -> [Self; 2] {
        let channel = self.channel;
        self.colors.sort_by_key(|&(color, _)| (color[channel], color));
        let half = self.colors.iter().map(|(_, count)| count).sum::<u64>() / 2;
        let mut before = 0;
        let cut = self.colors.iter().take_while(|(_, count)| {
            before += count;
            before <= half
        });
        let cut = cut.count().clamp(1, self.colors.len() - 1);
        let rest = self.colors.split_off(cut);
        [Self::of(self.colors), Self::of(rest)]
    }

    /// Returns the most frequent color if it has half of the pixels, so that plain areas stay as they are,
    /// and otherwise the mean.
    fn color(&self) -> Color {
        let all: u64 = self.colors.iter().map(|(_, count)| count).sum();
        let frequent = self.colors.iter().max_by_key(|(_, count)| count);
        if let Some(&(color, _)) = frequent.filter(|(_, count)| 2 * count >= all) {
            return color;
        }
        let mean = |channel: usize| {
            let sum: u64 = self.colors.iter().map(|&(color, count)| u64::from(color[channel]) * count).sum();
            ((sum + all / 2) / all.max(1)) as u8
        };
        [mean(0), mean(1), mean(2)]
    }
}
