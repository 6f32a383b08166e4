//! Drawing: lines, discs and text over a picture.

use font8x8::UnicodeFonts;

/// Side of a letter in pixels, times the scale of the text.
pub const LETTER: i32 = 8;

/// Pixels to draw on, `0x00RRGGBB`, row by row from the top. What lies outside is not drawn.
pub struct Canvas<'a> {
    /// The pixels.
    pub pixels: &'a mut [u32],
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

/// A colour and how much of it covers what is below, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink(pub u32, pub f32);

impl Canvas<'_> {
    /// Draws one pixel.
    pub fn dot(&mut self, x: i32, y: i32, Ink(color, cover): Ink) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x < self.width && y < self.height {
            let pixel = &mut self.pixels[y * self.width + x];
            *pixel = blend(*pixel, color, cover);
        }
    }

    /// Draws a line of the given thickness in pixels.
    pub fn line(&mut self, from: (f32, f32), to: (f32, f32), thickness: f32, ink: Ink) {
        if ![from.0, from.1, to.0, to.1].iter().all(|place| place.is_finite()) {
            return;
        }
        let radius = 0.5 * thickness + 0.5;
        let along = (to.0 - from.0, to.1 - from.1);
        let length_squared = (along.0 * along.0 + along.1 * along.1).max(1e-6);
        let (width, height) = (self.width, self.height);
        let mut cover = |x: i32, y: i32| {
            let offset = (x as f32 + 0.5 - from.0, y as f32 + 0.5 - from.1);
            let t = ((offset.0 * along.0 + offset.1 * along.1) / length_squared).clamp(0.0, 1.0);
            let distance = (offset.0 - t * along.0).hypot(offset.1 - t * along.1);
            self.dot(x, y, Ink(ink.0, ink.1 * (radius - distance).clamp(0.0, 1.0)));
        };
        // Goes along the axis in which the line is longer, and covers a few pixels across at each step.
        if along.0.abs() >= along.1.abs() {
            steps((from.0, from.1), (to.0, to.1), radius, width).for_each(|(x, low, high)| {
                (low..=high).for_each(|y| cover(x, y));
            });
        } else {
            steps((from.1, from.0), (to.1, to.0), radius, height).for_each(|(y, low, high)| {
                (low..=high).for_each(|x| cover(x, y));
            });
        }
    }

    /// Draws a filled circle.
    pub fn disc(&mut self, (x, y): (f32, f32), radius: f32, ink: Ink) {
        self.line((x, y), (x, y), 2.0 * radius, ink);
    }

    /// Covers a rectangle.
    pub fn shade(&mut self, left: i32, top: i32, width: i32, height: i32, ink: Ink) {
        for y in top.max(0)..(top + height).min(self.height as i32) {
            for x in left.max(0)..(left + width).min(self.width as i32) {
                self.dot(x, y, ink);
            }
        }
    }

    /// Writes one line of text, each letter `8 · scale` pixels wide and high.
    pub fn text(&mut self, left: i32, top: i32, scale: i32, text: &str, ink: Ink) {
        for (index, letter) in text.chars().enumerate() {
            let rows = font8x8::BASIC_FONTS.get(letter).or_else(|| font8x8::LATIN_FONTS.get(letter));
            let rows = rows.or_else(|| font8x8::BASIC_FONTS.get('?')).unwrap_or_default();
            let corner = left + LETTER * scale * index as i32;
            for (y, row) in (0..).zip(rows) {
                for x in (0..LETTER).filter(|x| row & (1 << x) != 0) {
                    self.shade(corner + scale * x, top + scale * y, scale, scale, ink);
                }
            }
        }
    }

    /// Writes lines on a dark ground with its upper left corner at the given place. Returns the height of the ground.
    pub fn panel(&mut self, left: i32, top: i32, scale: i32, lines: &[(String, u32)]) -> i32 {
        let (step, margin) = ((LETTER + 3) * scale, 4 * scale);
        let longest = lines.iter().map(|(line, _)| line.chars().count()).max().unwrap_or(0) as i32;
        let height = step * lines.len() as i32 + 2 * margin - 3 * scale;
        self.shade(left, top, LETTER * scale * longest + 2 * margin, height, Ink(0x00_00_00, 0.75));
        for (index, (line, color)) in lines.iter().enumerate() {
            self.text(left + margin, top + margin + step * index as i32, scale, line, Ink(*color, 1.0));
        }
        height
    }
}

/// For each pixel along the longer axis of a line, the first and last pixel that it may cover across. Ends are given as
/// places along and across.
fn steps(
    from: (f32, f32),
    to: (f32, f32),
    radius: f32,
    limit: usize,
) -> impl Iterator<Item = (i32, i32, i32)> {
    let slope = if to.0 == from.0 { 0.0 } else { (to.1 - from.1) / (to.0 - from.0) };
    let first = (from.0.min(to.0) - radius).floor().clamp(0.0, limit as f32) as i32;
    let last = (from.0.max(to.0) + radius).ceil().clamp(-1.0, limit as f32 - 1.0) as i32;
    (first..=last).map(move |step| {
        let center = from.1 + slope * (step as f32 + 0.5 - from.0);
        let reach = 1.5 * radius + 1.0;
        (step, (center - reach).floor() as i32, (center + reach).ceil() as i32)
    })
}

fn blend(below: u32, above: u32, cover: f32) -> u32 {
    let channel = |shift: u32| {
        let (below, above) = ((below >> shift & 0xff) as f32, (above >> shift & 0xff) as f32);
        ((below + cover * (above - below)).round() as u32) << shift
    };
    channel(16) | channel(8) | channel(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(draw: impl FnOnce(&mut Canvas<'_>)) -> Vec<u32> {
        let mut pixels = vec![0; 20 * 10];
        draw(&mut Canvas { pixels: &mut pixels, width: 20, height: 10 });
        pixels
    }

    #[test]
    fn a_line_covers_its_ends_and_middle_and_nothing_else() {
        let pixels = drawn(|canvas| canvas.line((2.5, 5.5), (16.5, 5.5), 1.0, Ink(0xff_ff_ff, 1.0)));
        for x in [2, 9, 16] {
            assert_eq!(pixels[5 * 20 + x], 0xff_ff_ff, "column {x}");
        }
        assert_eq!(pixels[5 * 20 + 19], 0);
        assert!(pixels[..3 * 20].iter().chain(&pixels[8 * 20..]).all(|pixel| *pixel == 0));
    }

    #[test]
    fn what_lies_outside_is_not_drawn() {
        let pixels = drawn(|canvas| {
            canvas.line((-50.0, -50.0), (-5.0, 90.0), 3.0, Ink(0xff, 1.0));
            canvas.text(-100, -3, 1, "left", Ink(0xff, 1.0));
            canvas.disc((f32::NAN, 2.0), 3.0, Ink(0xff, 1.0));
        });
        assert!(pixels.iter().all(|pixel| *pixel == 0));
        let corner = drawn(|canvas| canvas.shade(-5, -5, 6, 6, Ink(0x10_20_30, 1.0)));
        assert_eq!((corner[0], corner[1], corner[20]), (0x10_20_30, 0, 0));
    }

    #[test]
    fn text_is_legible() {
        let pixels = drawn(|canvas| canvas.text(1, 1, 1, "I", Ink(1, 1.0)));
        let rows =
            pixels.chunks(20).map(|row| row.iter().map(|&dot| if dot == 1 { '#' } else { '.' }).collect());
        let rows: Vec<String> = rows.collect();
        assert_eq!((&rows[1][1..9], &rows[3][1..9]), (".####...", "..##...."), "{rows:#?}");
    }

    #[test]
    fn ink_blends_with_what_is_below() {
        assert_eq!(blend(0x00_80_ff, 0xff_80_00, 0.0), 0x00_80_ff);
        assert_eq!(blend(0x00_80_ff, 0xff_80_00, 1.0), 0xff_80_00);
        assert_eq!(blend(0x00_00_00, 0xc8_64_00, 0.5), 0x64_32_00);
    }
}
