//! Whether hand-ins can be graded on this machine, found out with an empty one before any code of a student is compiled.

use arty::integrator::{Settings, Technique};
use arty::math::{Rgb, Vec3};
use arty::scene::{CameraDescription, Defaults, Material, Mesh, MeshTriangle, SceneDescription, Specular};
use host::protocol::{RenderJob, Switches};

use crate::build::{Framework, compile_empty};
use crate::error::{Error, Result};
use crate::host_process::{Fault, HostProcess};
use crate::report::Sandbox;
use crate::sandbox::{Level, Limits};

/// Has an empty hand-in compiled, started, and render a picture. What it cannot do is the fault of the machine or of the
/// framework, and not of the hand-ins that cannot do it either.
///
/// # Errors
/// If it cannot, or if the sandbox is worse than `limits.least`.
pub(crate) fn require_that_hand_ins_work(framework: &Framework, limits: &Limits) -> Result<()> {
    let program = compile_empty(framework, limits)?;
    let mut process = HostProcess::start(&program, 1)?;
    let failed = |fault: &Fault| Error::Harness(format!("not even an empty hand-in works here: {fault}"));
    process.fault().map_or(Ok(()), |fault| Err(failed(fault)))?;
    require(&Sandbox::new(program.layers, process.layers(), Vec::new()), limits.least)?;
    let scene = process.load(&empty_scene())?.map_err(|fault| failed(&fault))?;
    let job = RenderJob {
        scene,
        settings: Settings { technique: Technique::Nee, max_bounces: 1 },
        width: 4,
        height: 4,
        seeds: vec![1],
        first_sample: 0,
        samples: 1,
        switches: Switches::default(),
    };
    let rendered = process.render(&job)?.map_err(|fault| failed(&fault))?;
    if rendered.batches.iter().flatten().flatten().any(|&value| value != 0.0) {
        return Err(failed(&Fault::Malformed("a picture that is not black".to_owned())));
    }
    Ok(())
}

/// A triangle in front of a camera, and no light.
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
    }
}

/// Refuses a sandbox that is worse than `least`.
///
/// # Errors
/// If it is.
pub(crate) fn require(sandbox: &Sandbox, least: Level) -> Result<()> {
    if sandbox.level >= least {
        return Ok(());
    }
    let Sandbox { level, missing, .. } = sandbox;
    Err(Error::Input(format!(
        "the sandbox is `{level}` here ({missing}), and `{least}` is asked for: see `grader doctor`, or give \
         --allow-sandbox={level} if you trust everybody whose file is graded"
    )))
}
