//! A reference to compare with.

use std::path::Path;

use arty::diagnostic::Diagnostic;
use arty::image::Image;
use arty::image::error::{Truth, relative_mse};
use arty::image::exr::ExrFile;

/// A reference image.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The image.
    pub image: Image,
    mean: Vec<[f64; 3]>,
    /// Variance of the mean; `None` if the file has none.
    variance: Option<Vec<[f64; 3]>>,
    /// Maximum number of bounces it was rendered with; `None` if the file does not tell.
    pub max_bounces: Option<u32>,
}

impl Reference {
    /// Reads a reference.
    ///
    /// # Errors
    ///
    /// If the file is not an OpenEXR file with a colour image of finite values.
    pub fn read(path: &Path) -> Result<Self, Diagnostic> {
        let file = ExrFile::read(path)?;
        let refuse = |message: &str| Diagnostic::about(path, message);
        let image = file.layer("").ok_or_else(|| refuse("it has no layer with the channels R, G and B"))?;
        if image.pixels().iter().any(|pixel| !pixel.is_finite()) {
            return Err(refuse("it contains NaN or infinite values"));
        }
        let variance = file.layer("variance").map(|layer| values(&layer));
        let variance = variance.filter(|list| list.iter().flatten().all(|value| value.is_finite()));
        let max_bounces = file.metadata.get("arty:max_bounces").and_then(|text| text.parse().ok());
        Ok(Self { mean: values(&image), image, variance, max_bounces })
    }

    /// Relative mean squared error of an image of the same size.
    pub fn relative_mse(&self, image: &Image) -> f64 {
        relative_mse(&values(image), Truth { mean: &self.mean, variance: self.variance.as_deref() })
    }
}

fn values(image: &Image) -> Vec<[f64; 3]> {
    image.pixels().iter().map(|pixel| pixel.to_array().map(f64::from)).collect()
}
