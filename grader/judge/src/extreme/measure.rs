//! Measuring the mean of one picture, its standard error and the samples that are not radiance.

use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use host::protocol::{AnomalousSample, RenderJob};

use super::answers::{Answer, ExtremeScene};
use harness::host_process::HostProcess;
use harness::job::JobError;
use verdict::check::Fault;

/// Number of batches.
const BATCHES: u64 = 32;

/// Number of standard errors that count as noise. With 31 degrees of freedom, a mean exceeds it once in 50 million
/// times.
pub const NOISE: f64 = 7.0;

/// Minimum number of paths of one measurement.
#[derive(Clone, Copy, Debug)]
pub struct MinPaths(pub u64);

/// The measurement of one picture.
#[derive(Clone, Debug, Default)]
pub struct Measurement {
    /// Mean over all pixels and channels.
    pub mean: f64,
    /// Standard error of `mean`.
    pub standard_error: f64,
    /// Number of samples that were NaN or infinite. They count as black in the mean.
    pub non_finite: u64,
    /// Number of samples that were negative.
    pub negative: u64,
    /// The first such sample.
    pub first: Option<AnomalousSample>,
    /// The message of a panic, after which nothing was measured.
    pub panic: Option<String>,
    /// Number of paths traced.
    pub paths: u64,
    /// Processor time of all paths, in seconds.
    pub seconds: f64,
}

impl Measurement {
    /// Error of the mean relative to the exact mean; absolute if that is 0.
    pub fn error(&self, truth: f64) -> f64 {
        relative(self.mean - truth, truth)
    }

    /// Error that noise explains, relative to the exact mean; absolute if that is 0.
    pub fn noise(&self, truth: f64) -> f64 {
        relative(NOISE * self.standard_error, truth)
    }

    /// True if no sample was NaN, infinite or negative.
    pub fn is_clean(&self) -> bool {
        self.non_finite + self.negative == 0
    }
}

fn relative(value: f64, truth: f64) -> f64 {
    if truth == 0.0 { value } else { value / truth.abs() }
}

/// Measures a scene that the process has loaded.
///
/// # Errors
/// If the program gives no valid answer, or the grader itself fails.
pub fn measure(
    process: &mut HostProcess,
    scene: u32,
    settings: Settings,
    size: [u32; 2],
    MinPaths(paths): MinPaths,
    seed: u64,
) -> Result<Measurement, JobError> {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let samples = paths.div_ceil(pixels * BATCHES);
    let seeds = (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect();
    let rendered = process.render(&RenderJob::new(scene, settings, size, seeds, samples))?;
    let mean_of = |batch: &Vec<[f32; 3]>| {
        batch.iter().flatten().map(|&value| f64::from(value)).sum::<f64>() / (3 * batch.len()) as f64
    };
    let means: Vec<f64> = rendered.batches.iter().map(mean_of).collect();
    let (mean, standard_error) = mean_and_error(&means);
    Ok(Measurement {
        mean,
        standard_error,
        non_finite: rendered.non_finite,
        negative: rendered.negative,
        first: rendered.first_anomalies.into_iter().next(),
        panic: None,
        paths: pixels * samples * BATCHES,
        seconds: rendered.cpu_seconds,
    })
}

/// Mean and standard error of some numbers.
///
/// The numbers are scaled by the largest, so that squares of numbers such as 1e300 neither overflow nor underflow.
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let scale = values.iter().fold(0.0, |max: f64, value| max.max(value.abs()));
    if scale == 0.0 || values.is_empty() {
        return (0.0, 0.0);
    }
    let count = values.len() as f64;
    let mean = values.iter().map(|value| value / scale).sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value / scale - mean).powi(2)).sum();
    (scale * mean, scale * (squares / (count - 1.0).max(1.0) / count).sqrt())
}

/// A program's result in an extreme scene.
#[derive(Clone, Debug)]
pub struct ExtremeSceneResult {
    /// Name of the scene.
    pub scene: String,
    /// Settings of the path tracer.
    pub settings: Settings,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Exact mean.
    pub truth: f64,
    /// Measured mean.
    pub measured: Measurement,
    /// Relative error that rounding and noise explain.
    pub allowed: f64,
    /// True if failures cost points.
    pub is_graded: bool,
}

impl ExtremeSceneResult {
    /// True if the error is explained by rounding and noise, all samples are radiance, and the program did not panic.
    pub fn is_right(&self) -> bool {
        self.measured.panic.is_none()
            && self.measured.is_clean()
            && self.measured.error(self.truth).abs() <= self.allowed
    }
}

/// Measures the wanted extreme scenes that a technique can render. A panic in one of them is the result there.
///
/// # Errors
/// If the program otherwise gives no valid answer, or the grader itself fails.
pub fn measure_all(
    process: &mut HostProcess,
    extremes: &[ExtremeScene],
    technique: Technique,
    effort: MinPaths,
    seed: u64,
    mut wanted: impl FnMut(&Answer) -> bool,
) -> Result<Vec<ExtremeSceneResult>, JobError> {
    let mut findings: Vec<ExtremeSceneResult> = Vec::new();
    for ExtremeScene { answer, description } in extremes {
        if answer.left_out.contains_key(&technique) || !wanted(answer) {
            continue;
        }
        let settings = Settings { technique, max_bounces: answer.max_bounces };
        let scene = process.load(description)?;
        let measured = match measure(process, scene, settings, answer.size, effort, seed) {
            Err(JobError::Submission(Fault::Panic(message))) => {
                Measurement { panic: Some(message), ..Measurement::default() }
            }
            measured => measured?,
        };
        let compared = |name: &String| findings.iter().find(|finding| finding.scene == *name);
        let other = answer.same_as.as_ref().and_then(compared).map(|finding| finding.measured.mean);
        let truth = answer.radiance.or(other).unwrap_or(measured.mean);
        // A translated scene uses the same random numbers, so that noise explains no difference.
        let noise = if answer.radiance.is_some() { measured.noise(truth) } else { 0.0 };
        findings.push(ExtremeSceneResult {
            scene: answer.scene.clone(),
            settings,
            size: answer.size,
            truth,
            measured,
            allowed: answer.tolerance + noise,
            is_graded: answer.is_graded,
        });
    }
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_any_magnitude_have_a_standard_error() {
        for scale in [1e-300, 1e-30, 1.0, 1e30, 1e300] {
            let (mean, error) = mean_and_error(&[scale, 3.0 * scale]);
            assert!((mean / scale - 2.0).abs() < 1e-12 && (error / scale - 1.0).abs() < 1e-12, "{scale}");
        }
        assert_eq!(mean_and_error(&[]), (0.0, 0.0));
        assert_eq!(mean_and_error(&[0.0; 4]), (0.0, 0.0));
        assert_eq!(mean_and_error(&[5.0]), (5.0, 0.0));
    }

    #[test]
    fn wrong_means_and_samples_that_are_not_radiance_fail() {
        let finding = |mean, allowed, negative| ExtremeSceneResult {
            scene: String::new(),
            settings: Settings { technique: Technique::Nee, max_bounces: 1 },
            size: [1, 1],
            truth: 1e-20,
            measured: Measurement { mean, negative, ..Measurement::default() },
            allowed,
            is_graded: true,
        };
        assert!(finding(1.0005e-20, 1e-3, 0).is_right());
        assert!(!finding(1.01e-20, 1e-3, 0).is_right());
        assert!(!finding(0.0, 1e-3, 0).is_right());
        assert!(!finding(f64::NAN, 1e-3, 0).is_right());
        assert!(!finding(1e-20, 1e-3, 1).is_right());
        let mut panicked = finding(1e-20, 1e-3, 0);
        panicked.measured.panic = Some("index out of bounds".to_owned());
        assert!(!panicked.is_right());
    }
}
