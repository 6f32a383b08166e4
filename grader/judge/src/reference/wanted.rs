//! The references that all assignments of a checkout need.

use std::collections::BTreeMap;

use arty::integrator::Technique;
use harness::assignment::{Assignment, default_name};
use harness::workspace::Workspace;
use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, View};

use super::Reference;

/// The views that a scene's reference needs, with the techniques whose moments it records.
pub type Wanted = BTreeMap<View, Vec<Technique>>;

/// The references that all assignments need: the union of their rubrics' views, by scene, and the name of the assignment
/// whose solution renders it. That is the default assignment, if its rubric names the scene and it has all techniques,
/// or else the first such one by name.
///
/// # Errors
/// If a rubric is wrong, or no assignment with a scene has all of its techniques.
pub fn wanted_of_all(workspace: &Workspace) -> Result<BTreeMap<String, (Wanted, String)>> {
    let mut names = workspace.assignments()?;
    if let Ok(default) = default_name(workspace, None) {
        names.sort_by_key(|name| *name != default);
    }
    let all = names.iter().map(|name| Assignment::open(workspace, name)).collect::<Result<Vec<_>>>()?;
    let mut scenes: BTreeMap<String, Wanted> = BTreeMap::new();
    for assignment in &all {
        for (scene, views) in assignment.rubric.scenes() {
            let known = scenes.entry(scene.to_owned()).or_default();
            for (view, techniques) in views {
                let list = known.entry(view).or_default();
                list.extend(techniques);
                list.sort();
                list.dedup();
            }
        }
    }
    let with_renderer = |(scene, wanted): (String, Wanted)| {
        let renders = |assignment: &&Assignment| {
            assignment.rubric.scenes().contains_key(scene.as_str())
                && wanted.values().flatten().all(|it| assignment.rubric.techniques.contains(it))
        };
        let Some(renderer) = all.iter().find(renders) else {
            return Err(Error::Input(format!(
                "no assignment that names the scene `{scene}` in its rubric has all techniques that its reference needs"
            )));
        };
        let name = renderer.name.clone();
        Ok((scene, (wanted, name)))
    };
    scenes.into_iter().map(with_renderer).collect()
}

impl Reference {
    /// What a check needs and the reference lacks, such as `bounces 8 with bsdf`; `None` if it lacks nothing.
    pub fn lacks(&self, spec: &CheckSpec) -> Option<String> {
        let view = spec.view();
        let has = |technique: &Technique| {
            self.views.get(&view).is_some_and(|images| images.techniques.contains_key(technique.name()))
        };
        let missing = spec.techniques().into_iter().find(|technique| !has(technique));
        let layer = super::file::layer_name(&view);
        match missing {
            Some(technique) => Some(format!("{layer} with {technique}")),
            None => (!self.views.contains_key(&view)).then_some(layer),
        }
    }
}
