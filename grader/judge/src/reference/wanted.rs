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

#[cfg(test)]
mod tests {
    use super::super::Moments;
    use super::*;
    use verdict::check::CheckKind;

    #[test]
    fn a_reference_lacks_the_views_and_techniques_that_it_does_not_hold() {
        let mut reference = Reference::default();
        let spec = CheckSpec::new(CheckKind::MeanBias, Technique::Bsdf, 8);
        assert_eq!(reference.lacks(&spec).as_deref(), Some("bounces8 with bsdf"));
        let view = reference.views.entry(spec.view()).or_default();
        view.techniques.insert("mis", Moments::default());
        assert_eq!(reference.lacks(&spec).as_deref(), Some("bounces8 with bsdf"));
        let view = reference.views.entry(spec.view()).or_default();
        view.techniques.insert("bsdf", Moments::default());
        assert_eq!(reference.lacks(&spec), None);
        let randomness = CheckSpec::new(CheckKind::Randomness, Technique::Bsdf, 3);
        assert_eq!(reference.lacks(&randomness).as_deref(), Some("bounces3"));
    }

    /// References are complete: nobody has to wait for one at the beginning of a course.
    #[test]
    fn the_references_hold_what_the_rubrics_of_all_assignments_ask_for() {
        let workspace = Workspace::find().expect("the tests run inside the checkout");
        let wanted = wanted_of_all(&workspace).expect("each scene has a solution that renders it");
        for name in workspace.assignments().expect("they can be listed") {
            let rubric = Assignment::open(&workspace, &name).expect("it is sound").rubric;
            for (_, spec) in rubric.checks().filter(|(_, spec)| spec.check.needs_scene()) {
                assert!(wanted[&spec.scene].0.contains_key(&spec.view()), "{name}: {}", spec.id());
                let file = workspace.scene_file(&spec.scene);
                let description = arty::scene::file::load(&file).expect("it is there").description;
                let path = workspace.reference_file(&spec.scene);
                let reference =
                    super::super::load(&path, &spec.scene, &description).expect("it is up to date");
                assert_eq!(reference.lacks(spec), None, "{name}: {}", spec.id());
            }
        }
    }
}
