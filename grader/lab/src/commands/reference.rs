//! `cargo lab reference`.

use std::path::Path;
use std::process::ExitCode;

use arty::image::exr::{ExrFile, Precision};
use arty::integrator::{Settings, Technique};
use arty::scene::file::load;

use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use judge::reference::{self, Effort};
use verdict::error::{Error, Result};

/// Width and height of the pictures to look at.
const PICTURE_SIZE: (u32, u32) = (320, 256);

/// Samples of each of their pixels.
const PICTURE_SAMPLES: u64 = 256;

/// Render references with the solution.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Scenes by name [default: all that the assignment checks]
    scenes: Vec<String>,
    #[command(flatten)]
    assignment: Assignment,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 20_190_501)]
    seed: u64,
    /// Leave out the pictures to look at
    #[arg(long)]
    no_pictures: bool,
    /// Render only the pictures to look at
    #[arg(long, conflicts_with = "no_pictures")]
    only_pictures: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let mut wanted = rubric.scenes();
    if let Some(unknown) = arguments.scenes.iter().find(|scene| !wanted.contains_key(scene.as_str())) {
        let known: Vec<&str> = wanted.keys().copied().collect();
        return Err(Error::Input(format!(
            "no check uses a scene `{unknown}`; there are {}",
            known.join(", ")
        )));
    }
    wanted
        .retain(|scene, _| arguments.scenes.is_empty() || arguments.scenes.iter().any(|name| name == scene));

    let program = Oracle::required(&workspace)?;
    let count = wanted.len();
    for (index, (scene, wanted)) in wanted.into_iter().enumerate() {
        eprintln!("{scene} ({} of {count}) …", index + 1);
        let description = load(&workspace.scene_file(scene))?.description;
        if !arguments.only_pictures {
            let made = reference::make(&program, &description, &wanted, Effort::default(), arguments.seed)?;
            make_folder_of(&workspace.reference_file(scene))?;
            reference::save(&made, &workspace.reference_file(scene))?;
        }
        if !arguments.no_pictures {
            let max_bounces = wanted.keys().next_back().map_or(1, |view| view.max_bounces);
            let settings = Settings { technique: Technique::Mis, max_bounces };
            let picture = reference::picture(
                &program,
                &description,
                settings,
                PICTURE_SIZE,
                PICTURE_SAMPLES,
                arguments.seed,
            )?;
            let file = ExrFile::new(&picture)
                .with_metadata("arty:scene_hash", description.hash())
                .with_metadata("arty:max_bounces", max_bounces.to_string());
            let path = workspace.picture_file(scene);
            make_folder_of(&path)?;
            file.write(&path, Precision::Half)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn make_folder_of(path: &Path) -> Result<()> {
    path.parent()
        .map_or(Ok(()), |folder| std::fs::create_dir_all(folder).map_err(|error| Error::file(folder, error)))
}
