//! Batches: independent renderings of one image, which grow from look to look.

use super::regions::Region;

/// The means of all batches, by pixel and channel.
#[derive(Clone, Debug, Default)]
pub struct Batches {
    means: Vec<Vec<[f64; 3]>>,
    /// Samples per pixel and batch.
    samples: u64,
}

impl Batches {
    /// Adds `samples` samples per pixel to each batch, given as their means.
    ///
    /// # Panics
    /// If the number of batches or pixels differs from that of earlier samples.
    pub fn extend(&mut self, means: &[Vec<[f32; 3]>], samples: u64) {
        if self.samples == 0 {
            self.means = means.iter().map(|batch| vec![[0.0; 3]; batch.len()]).collect();
        }
        assert_eq!(self.means.len(), means.len(), "batches");
        let share = samples as f64 / (self.samples + samples) as f64;
        for (old, new) in self.means.iter_mut().zip(means) {
            assert_eq!(old.len(), new.len(), "pixels");
            for (old, new) in old.iter_mut().zip(new) {
                for (old, &new) in old.iter_mut().zip(new) {
                    *old += share * (f64::from(new) - *old);
                }
            }
        }
        self.samples += samples;
    }

    /// Number of batches.
    pub fn count(&self) -> usize {
        self.means.len()
    }

    /// Number of pixels of each batch.
    pub fn pixels(&self) -> usize {
        self.means.first().map_or(0, Vec::len)
    }

    /// Samples per pixel over all batches.
    pub fn samples_per_pixel(&self) -> u64 {
        self.samples * self.means.len() as u64
    }

    /// Estimated variance of one sample of a pixel's channel: the variance of the batches' means times the number of
    /// samples per batch.
    pub fn variance(&self, pixel: usize, channel: usize) -> f64 {
        let count = self.means.len() as f64;
        let mean = self.means.iter().map(|batch| batch[pixel][channel]).sum::<f64>() / count;
        let squares: f64 = self.means.iter().map(|batch| (batch[pixel][channel] - mean).powi(2)).sum();
        squares / (count - 1.0).max(1.0) * self.samples as f64
    }

    /// The contrast of each batch: its weighted sum over the pixels and channels of a region.
    pub fn contrast<'a>(&'a self, region: &'a Region) -> impl Iterator<Item = f64> + 'a {
        self.means.iter().map(move |batch| {
            let products = region.weights.iter().map(|(pixel, weights)| (batch[*pixel], weights));
            products.map(|(means, weights)| (0..3).map(|c| means[c] * weights[c]).sum::<f64>()).sum()
        })
    }

    /// The mean of a pixel's channel in each batch.
    pub fn values(&self, pixel: usize, channel: usize) -> impl Iterator<Item = f64> + '_ {
        self.means.iter().map(move |batch| batch[pixel][channel])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::{Channel, RegionId, RegionKind};

    #[test]
    fn samples_added_in_parts_have_the_mean_of_all() {
        let mut batches = Batches::default();
        batches.extend(&[vec![[1.0, 2.0, 3.0]], vec![[0.0; 3]]], 1);
        batches.extend(&[vec![[5.0, 2.0, 0.0]], vec![[4.0; 3]]], 3);
        assert_eq!((batches.count(), batches.samples_per_pixel()), (2, 8));
        let weights = vec![(0, [1.0, 0.0, 0.0])];
        let region = Region {
            id: RegionId { kind: RegionKind::Channel(Channel::Red), pixels: None },
            level: 0,
            weights,
        };
        let red: Vec<f64> = batches.contrast(&region).collect();
        assert_eq!(red, [4.0, 3.0]);
    }
}
