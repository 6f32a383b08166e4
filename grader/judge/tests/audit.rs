//! The audit, on submissions that are right, wrong, and right in another style.

use std::sync::OnceLock;

use harness::assignment::Assignment;
use harness::build::{Framework, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::audit::audit;
use verdict::audit::{Audit, Fact};

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

/// The audit of the solution with texts replaced, each of which must occur exactly once.
fn audited(changes: &[(&str, &str)]) -> Audit {
    static FRAMEWORK: OnceLock<Framework> = OnceLock::new();
    let framework = FRAMEWORK.get_or_init(|| assignment().framework(&workspace()).expect("it is built"));
    let mut source = assignment().solution().expect("the solution is there");
    for (from, to) in changes {
        assert_eq!(source.matches(from).count(), 1, "{from}");
        source = source.replace(from, to);
    }
    let program = compile(framework, &source, &Limits::default()).expect("the compiler works");
    let program = program.unwrap_or_else(|failure| panic!("{}", failure.messages));
    audit(&program, 1).expect("the harness works")
}

/// The names of the facts that fail.
fn failed(changes: &[(&str, &str)]) -> Vec<String> {
    audited(changes).failed().map(Fact::id).collect()
}

#[test]
fn every_fact_holds_for_the_solution_and_with_the_power_heuristic() {
    for changes in [&[][..], &[("1.0 / (1.0 + q / p)", "1.0 / (1.0 + (q / p) * (q / p))")]] {
        let audit = audited(changes);
        assert_eq!(audit.fault, None, "{changes:?}");
        assert!(audit.facts.len() > 400, "{} facts", audit.facts.len());
        assert_eq!(audit.failed().map(Fact::id).collect::<Vec<_>>(), Vec::<String>::new(), "{changes:?}");
    }
}

#[test]
fn a_wrong_factor_is_named_first_and_at_each_hit() {
    let distance = ("* distance * distance / sample.cos_light", "* distance / sample.cos_light");
    let failed = failed(&[distance]);
    assert_eq!(failed[0], "light-sample/distance/nee/1");
    assert!(failed.contains(&"light-sample/distance/nee/3".to_owned()), "{failed:?}");
    assert!(!failed.iter().any(|id| id.starts_with("hit/")), "{failed:?}");
}

#[test]
fn a_weight_of_the_wrong_density_is_told_from_the_others() {
    let viewer = ("balance(p_ne, bsdf.pdf(wi))", "balance(p_ne, bsdf.pdf(hit.wo))");
    let failed = failed(&[viewer]);
    assert!(failed[0].starts_with("light-weight/"), "{failed:?}");
    assert!(failed.iter().all(|id| !id.starts_with("hit-weight/")), "{failed:?}");
}
