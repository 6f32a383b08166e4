//! A trial with an empty submission, before any code of a student is compiled: can this machine grade at all?

use arty::integrator::{Settings, Technique};
use arty::math::{Rgb, Vec3};
use arty::scene::{CameraDescription, Defaults, Material, Mesh, MeshTriangle, SceneDescription, Specular};
use host::protocol::RenderJob;
use verdict::check::Fault;
use verdict::error::{Error, Result};
use verdict::report::Sandbox;

use crate::build::{Framework, compile_empty};
use crate::host_process::HostProcess;
use crate::job::JobError;
use crate::sandbox::{Level, Limits};

/// Compiles and starts an empty submission and lets it render an image. A failure is the fault of the machine or the
/// framework, so it is never blamed on a student's submission.
///
/// # Errors
/// If any step fails, or if the sandbox is weaker than `limits.min_level`.
pub fn require_that_submissions_work(framework: &Framework, limits: &Limits) -> Result<()> {
    let program = compile_empty(framework, limits)?;
    let mut process = HostProcess::start(&program, 1)?;
    process.fault().map_or(Ok(()), |fault| Err(failed(fault)))?;
    require(&Sandbox::new(program.layers, process.layers(), Vec::new()), limits.min_level)?;
    let settings = Settings { technique: Technique::Nee, max_bounces: 1 };
    let rendered = process
        .load(&empty_scene())
        .and_then(|scene| process.render(&RenderJob::new(scene, settings, [4, 4], vec![1], 1)))
        .map_err(|error| match error {
            JobError::Submission(fault) => failed(&fault),
            JobError::Harness(error) => error,
        })?;
    if rendered.batches.iter().flatten().flatten().any(|&value| value != 0.0) {
        return Err(failed(&Fault::Malformed("a picture that is not black".to_owned())));
    }
    Ok(())
}

fn failed(fault: &Fault) -> Error {
    Error::Harness(format!("not even an empty submission works here: {fault}"))
}

/// A scene with one triangle in front of the camera and no light.
fn empty_scene() -> SceneDescription {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let triangle = MeshTriangle { positions: [0, 1, 2], normals: None, uvs: None, material: 0 };
    let mesh = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)],
        triangles: vec![triangle],
        ..Mesh::default()
    };
    let material = Material {
        name: "gray".to_owned(),
        diffuse: Rgb::gray(0.5),
        diffuse_map: None,
        specular: Specular::None,
        emission: Rgb::BLACK,
    };
    SceneDescription {
        camera: CameraDescription { eye: Vec3::Z, center: Vec3::ZERO, up: Vec3::Y, fov: 60.0 },
        meshes: vec![mesh],
        materials: vec![material],
        textures: Vec::new(),
        lights: Vec::new(),
        defaults: Defaults::default(),
        environment: None,
    }
}

/// Refuses a sandbox that is weaker than `min_level`.
///
/// # Errors
/// If it is weaker.
pub fn require(sandbox: &Sandbox, min_level: Level) -> Result<()> {
    if sandbox.level >= min_level {
        return Ok(());
    }
    let Sandbox { level, compiler, host, .. } = sandbox;
    let missing = compiler.and(*host).missing().join(", ");
    Err(Error::Input(format!(
        "the sandbox is `{level}` here, and `{min_level}` is asked for; missing: {missing}. Run `cargo grader doctor` to \
         see how to get it, or give --allow-sandbox={level} if you trust everybody whose file is graded"
    )))
}
