//! `cargo lab reference`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use arty::image::exr::{ExrFile, Precision};
use arty::integrator::{Settings, Technique};
use arty::scene::SceneDescription;
use arty::scene::file::load;

use crate::output::create_folder;
use harness::assignment::Assignment;
use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use judge::reference::{self, Effort, Oracle, Reference, Wanted};
use verdict::error::{Error, Result};

/// Width and height of pictures for viewing, in pixels.
const PICTURE_SIZE: (u32, u32) = (320, 256);

/// Samples per pixel of these pictures.
const PICTURE_SAMPLES: u64 = 256;

/// Render references with the solutions; the same seed gives identical files
///
/// A reference holds what the rubrics of all assignments need of its scene.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Names of scenes [default: all scenes that any assignment checks]
    scenes: Vec<String>,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 20_190_501)]
    seed: u64,
    /// Samples per pixel of each of 64 batches; a reference records it [default: 2048]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Render only what references lack, and keep the rest of them
    #[arg(long, conflicts_with = "only_pictures")]
    missing: bool,
    /// Skip the preview pictures
    #[arg(long)]
    no_pictures: bool,
    /// Render only the preview pictures
    #[arg(long, conflicts_with = "no_pictures")]
    only_pictures: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let mut wanted = reference::wanted_of_all(&workspace)?;
    if let Some(unknown) = arguments.scenes.iter().find(|scene| !wanted.contains_key(scene.as_str())) {
        let known: Vec<&str> = wanted.keys().map(String::as_str).collect();
        return Err(Error::Input(format!("no check uses a scene `{unknown}`; known: {}", known.join(", "))));
    }
    wanted.retain(|scene, _| arguments.scenes.is_empty() || arguments.scenes.contains(scene));

    let mut programs: BTreeMap<String, (Technique, Arc<SubmissionProgram>)> = BTreeMap::new();
    let count = wanted.len();
    let standard = Effort::default();
    let effort = Effort { samples: arguments.samples.unwrap_or(standard.samples), ..standard };
    for (index, (scene, (wanted, name))) in wanted.into_iter().enumerate() {
        eprintln!("{scene} ({} of {count}), by {name} …", index + 1);
        let (technique, program) = match programs.entry(name) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let assignment = Assignment::open(&workspace, place.key())?;
                let program = Oracle::required(&workspace, &assignment)?;
                place.insert((assignment.rubric.reference_technique, program))
            }
        };
        let description = load(&workspace.scene_file(&scene))?.description;
        if !arguments.only_pictures {
            let path = workspace.reference_file(&scene);
            let known =
                if arguments.missing { reference::load(&path, &scene, &description).ok() } else { None };
            let render = |wanted: &Wanted, effort| {
                reference::make(program, &description, wanted, *technique, effort, arguments.seed)
            };
            let made = match known {
                Some(known) => completed(known, &wanted, effort, render)?,
                None => render(&wanted, effort)?,
            };
            create_folder(path.parent().unwrap_or(workspace.root()))?;
            reference::save(&made, &path)?;
        }
        if !arguments.no_pictures {
            let max_bounces = wanted.keys().next_back().map_or(1, |view| view.max_bounces);
            let settings = Settings { technique: *technique, max_bounces };
            let path = workspace.picture_file(&scene);
            create_folder(path.parent().unwrap_or(workspace.root()))?;
            picture(program, &description, settings, arguments.seed, &path)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// A reference with the views and moments that it lacks.
fn completed(
    mut known: Reference,
    wanted: &Wanted,
    effort: Effort,
    render: impl Fn(&Wanted, Effort) -> Result<Reference>,
) -> Result<Reference> {
    let (of_known_views, new): (Wanted, Wanted) =
        wanted.clone().into_iter().partition(|(view, _)| known.views.contains_key(view));
    let lacking = of_known_views.into_iter().filter_map(|(view, mut techniques)| {
        techniques.retain(|technique| !known.views[&view].techniques.contains_key(technique.name()));
        (!techniques.is_empty()).then_some((view, techniques))
    });
    let lacking: Wanted = lacking.collect();
    // Their mean is known.
    let moments_only = Effort { batches: 2, samples: 1, ..effort };
    for (view, made) in render(&lacking, moments_only)?.views {
        known.views.entry(view).and_modify(|images| images.techniques.extend(made.techniques));
    }
    let made = render(&new, effort)?;
    known.views.extend(made.views);
    known.provenance.extend(made.provenance);
    Ok(known)
}

/// Renders a picture for viewing, of as many bounces as the reference has.
fn picture(
    program: &SubmissionProgram,
    description: &SceneDescription,
    settings: Settings,
    seed: u64,
    path: &Path,
) -> Result<()> {
    let picture = reference::picture(program, description, settings, PICTURE_SIZE, PICTURE_SAMPLES, seed)?;
    ExrFile::new(&picture)
        .with_metadata("arty:scene_hash", description.hash())
        .with_metadata("arty:max_bounces", settings.max_bounces.to_string())
        .write(path, Precision::Half)
        .map_err(|error| Error::Output(error.to_string()))
}
