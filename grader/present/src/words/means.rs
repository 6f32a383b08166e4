//! Means, and the changes of scenes in which they are tested.

use verdict::check::{
    ChangeTest, Channel, CheckResult, FurnaceTest, MeanTest, RegionId, RegionKind, SceneChange, VariantTest,
    Verdict,
};

use super::number::{count, percent, trimmed};

/// How the mean of a picture compares with what it should be.
pub(super) fn mean(test: &MeanTest, verdict: &Verdict) -> String {
    match verdict {
        Verdict::Pass => right(test),
        Verdict::Inconclusive => too_noisy(test),
        _ => biased(test),
    }
}

/// The same in a white furnace, with the energy of each bounce.
pub(super) fn furnace(furnace: &FurnaceTest, verdict: &Verdict) -> String {
    let text = mean(&furnace.test, verdict);
    if *verdict != Verdict::Fail || furnace.energy.is_empty() {
        return text;
    }
    let bounces = count(furnace.max_bounces as usize, "bounce");
    format!("with at most {bounces}, {text}; energy per bounce relative to exact: {}", energy(furnace))
}

/// "1.00, 2.00".
pub(super) fn energy(furnace: &FurnaceTest) -> String {
    furnace.energy.iter().map(|bounce| format!("{:.2}", bounce.relative)).collect::<Vec<_>>().join(", ")
}

/// The same in scenes that are drawn at random.
pub(super) fn variant(variant: &VariantTest, verdict: &Verdict) -> String {
    let text = mean(&variant.test, verdict);
    match verdict {
        Verdict::Pass => text,
        _ => format!("in scene {} of {}, {text}", variant.scene, variant.scenes),
    }
}

/// The same in scenes that are changed.
pub(super) fn change(change: &ChangeTest, verdict: &Verdict) -> String {
    match verdict {
        Verdict::Pass if change.changes == 1 => "1 scene change had the expected effect".to_owned(),
        Verdict::Pass => format!("{} scene changes had the expected effect", change.changes),
        _ => format!("with {}, {}", scene_change(change.change), mean(&change.test, verdict)),
    }
}

fn scene_change(change: SceneChange) -> &'static str {
    match change {
        SceneChange::Brighter => "all lights 1000 times as bright",
        SceneChange::Dimmer => "all lights 1/1000 as bright",
        SceneChange::Larger => "the scene scaled by 100",
        SceneChange::Smaller => "the scene scaled by 1/100",
        SceneChange::Rotated => "the scene rotated",
        SceneChange::Moved => "the scene moved",
        SceneChange::Tessellated => "triangles split into smaller ones",
        SceneChange::LightsSplit => "each light split into two",
        SceneChange::BlackObjects => "black objects added beside the scene",
        SceneChange::LightsApart => "the lights distributed over two scenes whose images are added",
    }
}

fn right(test: &MeanTest) -> String {
    let (Some(effect), Some([low, high])) = (test.effect, test.interval) else {
        return "the mean is correct".to_owned();
    };
    let within = effect.abs() + 0.5 * (high - low);
    format!("the mean is correct to within {} ({} allowed)", percent(within, 2), percent(test.tolerance, 1))
}

fn too_noisy(test: &MeanTest) -> String {
    match test.detectable {
        Some(detectable) if detectable < 1.0 => format!(
            "too noisy to judge: an error of {} could go unnoticed, and {} is allowed",
            percent(detectable, 1),
            percent(test.tolerance, 1)
        ),
        _ => "too noisy to judge".to_owned(),
    }
}

fn biased(test: &MeanTest) -> String {
    let RegionId { kind, pixels } = test.region;
    let place = pixels.map_or_else(String::new, |pixels| format!(" in {}", tile(pixels)));
    let channel = match kind {
        RegionKind::Channel(Channel::Red) => ", clearest in the red channel",
        RegionKind::Channel(Channel::Green) => ", clearest in the green channel",
        RegionKind::Channel(Channel::Blue) => ", clearest in the blue channel",
        RegionKind::Luminance | RegionKind::Weighted | RegionKind::Pattern => "",
    };
    match (kind, test.effect) {
        (RegionKind::Pattern, Some(effect)) => {
            format!("the means are {} off: the bias changes sign across the image", percent(effect.abs(), 1))
        }
        (_, effect) => format!("{}{channel}", off(effect, &place)),
    }
}

/// "the mean is 12 % too dark", "the mean is 2.1 times what it should be", "the image is black", at a place.
fn off(effect: Option<f64>, place: &str) -> String {
    match effect {
        None => format!("the image should be black{place}, but is not"),
        Some(effect) if effect <= -1.0 => format!("the image is black{place}"),
        Some(effect) if effect < 0.0 => format!("the mean is {} too dark{place}", percent(-effect, 1)),
        Some(effect) if effect < 0.5 => format!("the mean is {} too bright{place}", percent(effect, 1)),
        Some(effect) => format!("the mean is {} times what it should be{place}", trimmed(1.0 + effect, 2)),
    }
}

/// "columns 4–7, rows 8–11".
pub(super) fn tile([[left, right], [top, bottom]]: [[u32; 2]; 2]) -> String {
    let range = |first: u32, last: u32, one: &str| {
        if first == last { format!("{one} {first}") } else { format!("{one}s {first}–{last}") }
    };
    format!("{}, {}", range(left, right, "column"), range(top, bottom, "row"))
}

/// "direct light is 2.00 ± 0.01 times what it should be", where one picture's plain mean says so; none where it does not.
pub(super) fn factor(check: &CheckResult) -> Option<String> {
    let whole = check.mean_test()?.whole?;
    let tells = whole.relative.abs() > 2.0 * whole.margin && whole.relative > -0.995;
    tells.then(|| {
        let (factor, margin) = (1.0 + whole.relative, whole.margin.max(0.01));
        format!("{} is {factor:.2} ± {margin:.2} times what it should be", super::cause::light(check))
    })
}
