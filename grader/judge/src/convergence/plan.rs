//! How many renderings of which length a curve gets.

/// Renderings of one length in each block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlannedLevel {
    /// Samples per pixel of each rendering.
    pub(super) samples: u64,
    /// Number of renderings in each block.
    pub(super) renders: u64,
}

/// Minimum and maximum number of blocks.
const BLOCKS: (f64, f64) = (12.0, 64.0);

/// Processor time of one curve with the minimum number of blocks, in seconds. Four times the time gives twice as many
/// blocks of twice the length.
const SHORTEST: f64 = 0.3;

/// Number of blocks of a measurement in which each curve has this processor time, in seconds.
pub(super) fn blocks(seconds: f64) -> usize {
    (BLOCKS.0 * (seconds / SHORTEST).sqrt()).clamp(BLOCKS.0, BLOCKS.1) as usize
}

/// Minimum processor time of one rendering in seconds: shorter ones are mostly overhead.
const MIN_RENDER: f64 = 0.3e-3;

/// Maximum ratio of a length to the next shorter one.
const MAX_STEP: f64 = 4.0;

/// Maximum samples per pixel: a hundredth of those of the references, whose own error would otherwise count.
const MAX_SAMPLES: f64 = 1024.0;

/// Plans lengths of equal total time for a block of `seconds`, if a sample per pixel takes `per_sample` seconds. At least
/// one rendering of one sample.
pub(super) fn levels(seconds: f64, per_sample: f64, lengths: u32) -> Vec<PlannedLevel> {
    let total = seconds / f64::from(lengths.max(1)) / per_sample;
    let longest = total.clamp(1.0, MAX_SAMPLES);
    let shortest = (MIN_RENDER / per_sample).clamp(1.0, longest);
    let last = f64::from(lengths.max(2) - 1);
    let step = (longest / shortest).powf(1.0 / last).clamp(1.0, MAX_STEP);
    let level = |k: u32| {
        let samples = (longest / step.powf(last - f64::from(k))).round().max(1.0);
        PlannedLevel { samples: samples as u64, renders: (total / samples).round().max(1.0) as u64 }
    };
    let mut levels: Vec<PlannedLevel> = (0..lengths).map(level).collect();
    levels.dedup_by_key(|level| level.samples);
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_lengths_take_the_same_time() {
        let levels = levels(0.025, 0.15e-3, 4);
        assert_eq!(levels.len(), 4);
        assert!(levels.is_sorted_by(|a, b| a.samples < b.samples), "{levels:?}");
        for PlannedLevel { samples, renders } in levels {
            let total = samples * renders;
            assert!((30..=50).contains(&total), "{samples} × {renders}");
        }
    }

    #[test]
    fn a_slow_program_renders_single_samples() {
        assert_eq!(levels(0.025, 1.0, 4), [PlannedLevel { samples: 1, renders: 1 }]);
        assert_eq!((blocks(1e-3), blocks(1.2), blocks(1e6)), (12, 24, 64));
    }
}
