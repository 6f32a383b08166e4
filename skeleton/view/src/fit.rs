//! Where the picture lies in the window.

/// The largest place for a picture in a window that keeps its proportions, in the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Pixels of the window per pixel of the picture.
    pub scale: f32,
    /// Left edge of the picture in the window.
    pub left: f32,
    /// Upper edge of the picture in the window.
    pub top: f32,
}

impl Fit {
    /// The place of a picture of `picture` pixels in a window of `window` pixels.
    pub fn new(picture: (u32, u32), window: (u32, u32)) -> Self {
        let ratio = |window: u32, picture: u32| window as f32 / picture.max(1) as f32;
        let scale = ratio(window.0, picture.0).min(ratio(window.1, picture.1)).max(1e-3);
        let edge = |window: u32, picture: u32| (0.5 * (window as f32 - scale * picture as f32)).floor();
        Self { scale, left: edge(window.0, picture.0), top: edge(window.1, picture.1) }
    }

    /// A place in the window, as a place in the picture.
    pub fn to_picture(&self, (x, y): (f32, f32)) -> (f32, f32) {
        ((x - self.left) / self.scale, (y - self.top) / self.scale)
    }

    /// A place in the picture, as a place in the window.
    pub fn to_window(&self, (x, y): (f32, f32)) -> (f32, f32) {
        (self.left + self.scale * x, self.top + self.scale * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fills_a_window_of_its_size_and_is_centred_in_a_wider_one() {
        assert_eq!(Fit::new((400, 300), (400, 300)), Fit { scale: 1.0, left: 0.0, top: 0.0 });
        let wide = Fit::new((400, 300), (1000, 600));
        assert_eq!(wide, Fit { scale: 2.0, left: 100.0, top: 0.0 });
        assert_eq!(wide.to_picture((100.0, 600.0)), (0.0, 300.0));
        assert_eq!(wide.to_window((400.0, 150.0)), (900.0, 300.0));
    }
}
