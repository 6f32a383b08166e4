//! `grader class`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use jiff::tz::TimeZone;

use super::class_tables::{Systems, Tables, exit_status, print_changes};
use super::intake::reader;
use super::min_sandbox::MinSandbox;
use super::policy::policy;
use super::seed::Seed;
use classroom::class::roster::Roster;
use classroom::class::shard::{ClassHash, Shard, ShardFile};
use classroom::class::{Accepted, Class, RunOptions, has_results, run as grade_all};
use classroom::lock::FolderLock;
use classroom::policy::{Manifest, Policy, Receipt, parse_received};
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use judge::grade::Options;
use present::streams::note;
use verdict::error::{Error, Result};
use verdict::output;

/// Grade a class: a folder of submissions as exported by Moodle or ILIAS, or with one folder, archive or file per student
///
/// Applies deadlines and extensions, and writes a gradebook, an overview page, and the completed grade tables of course
/// systems.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folder with the submissions
    folder: PathBuf,
    /// Class roster (CSV or a spreadsheet); --moodle and --ilias add to it, or take its place
    #[arg(long, value_name = "FILE")]
    roster: Option<PathBuf>,
    /// The column `Group` of roster and worksheet names teams that hand in together
    #[arg(long)]
    teams: bool,
    /// Receipt times (columns student, received_at, md5, md5_received_at, path, team; or a table of Moodle or ILIAS with
    /// the time of submission); file times are never used
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Receipt time of submissions not listed in the manifest
    #[arg(long, value_name = "TIME")]
    received_at: Option<String>,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml")]
    course: Option<PathBuf>,
    #[command(flatten)]
    systems: Systems,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for the results; created if missing
    #[arg(long, value_name = "DIR", default_value = "class-report")]
    out: PathBuf,
    /// Submissions to grade at once, each with one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
    /// Resume an earlier run: grade only what has changed
    #[arg(long, conflicts_with = "regrade")]
    resume: bool,
    /// Grade everything again, and print which scores changed
    #[arg(long)]
    regrade: bool,
    /// Replace nothing: grade what has changed into the folder preview of --out, and print whose checks and points would
    /// change
    #[arg(long, conflicts_with_all = ["resume", "shard"])]
    preview: bool,
    /// Grade one of several parts of the class into a folder of its own in --out; `grader merge` puts them together
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Grade although more than half of the roster is missing
    #[arg(long)]
    allow_missing: bool,
    /// Grade submissions of people whom no roster or manifest names, as rows of their own
    #[arg(long)]
    allow_unknown: bool,
    /// Score only; skip the HTML pages and their images
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    seed: Seed,
    /// Run only these checks, selected by name, kind, scene, technique or task; repeatable. A task earns points only
    /// if all of its checks are run
    #[arg(long, value_name = "CHECK|SCENE|TASK", conflicts_with_all = ["moodle", "ilias"])]
    only: Vec<String>,
    #[command(flatten)]
    sandbox: MinSandbox,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    arguments.systems.check()?;
    let out = arguments.shard.map_or_else(|| arguments.out.clone(), |shard| shard.folder(&arguments.out));
    arguments.check_earlier_results(&out)?;
    let assignment = arguments.assignment.open(workspace)?;
    let policy = policy(&assignment, arguments.course.as_deref())?;
    let mut class = arguments.class(policy.as_ref())?;
    output::create_folder(&out.join("submissions"))?;
    let _lock = match arguments.shard {
        Some(_) => FolderLock::of_results_in_turn(&out)?,
        None => FolderLock::of_results(&out)?,
    };
    let shard = arguments.shard.map(|shard| (shard, ClassHash::of(&class, policy.as_ref())));
    if let Some((shard, _)) = &shard {
        // Half of it is no shard to be merged.
        output::remove(&ShardFile::path(&out))?;
        class.keep(*shard);
    }
    let options = arguments.options(&assignment.name, out.clone())?;
    let tables = Tables {
        systems: &arguments.systems,
        rubric: &assignment.rubric,
        out: &out,
        page: !arguments.no_report,
    };
    let part = arguments.shard.map_or_else(String::new, |shard| format!(", {shard}"));
    note(format_args!("{} in the class{part}, {} at once", class.members.len(), options.jobs));
    let outcome = grade_all(workspace, &class, policy.as_ref(), &options, |rows| {
        if options.preview { Ok(()) } else { tables.save_gradebook(rows) }
    })?;
    let status = exit_status(&outcome);
    if options.preview {
        print_changes(&outcome)?;
        note("nothing was replaced: --regrade or --resume does that");
    } else if let Some((shard, hash)) = shard {
        tables.save_gradebook(&outcome.rows.iter().collect::<Vec<_>>())?;
        note(format_args!("{shard}: {} graded now, {} unchanged", outcome.graded, outcome.unchanged));
        ShardFile::new(shard, hash, class.keys, outcome).save(&out)?;
    } else {
        tables.save(&outcome, arguments.regrade)?;
    }
    if !arguments.only.is_empty() {
        note("note: with --only, sums include only tasks whose checks were all run");
    }
    Ok(ExitCode::from(status))
}

impl Arguments {
    fn check_earlier_results(&self, out: &Path) -> Result<()> {
        let earlier = has_results(out);
        if earlier && !(self.resume || self.regrade || self.preview) {
            return Err(Error::file(
                out,
                "there are results of an earlier run: --resume grades only what has changed, --regrade grades \
                 everything, --preview shows what either would change",
            ));
        }
        if self.preview && !earlier {
            return Err(Error::file(out, "there are no results of an earlier run to compare with"));
        }
        Ok(())
    }

    /// The members of the class with their submissions and receipt times.
    fn class(&self, policy: Option<&Policy>) -> Result<Class> {
        let roster = Roster::load(&self.tables_of_students(), self.teams)?;
        let zone = policy.map_or(TimeZone::UTC, |policy| policy.zone().clone());
        let manifest = self.manifest.as_ref().map(|path| Manifest::load(path, &zone)).transpose()?;
        let teams = manifest.as_ref().map(|manifest| manifest.teams().clone()).unwrap_or_default();
        let mut class = Class::find(&self.folder, &roster, &teams)?;
        if let Some(manifest) = &manifest {
            class.receive(manifest)?;
        }
        let accepted = Accepted { missing: self.allow_missing, unknown: self.allow_unknown };
        class.check(policy, manifest.as_ref(), accepted)?;
        if let Some(text) = &self.received_at {
            let time = parse_received(text, &zone)
                .map_err(|error| Error::Input(format!("--received-at: {error}")))?;
            for member in class.members.iter_mut().filter(|member| member.receipts.is_empty()) {
                member.receipts.push(Receipt { received_at: Some(time), ..Receipt::default() });
            }
        }
        Ok(class)
    }

    /// The files that name students; the first is the roster.
    fn tables_of_students(&self) -> Vec<&Path> {
        let tables = [&self.roster, &self.systems.moodle, &self.systems.ilias];
        tables.into_iter().filter_map(Option::as_deref).collect()
    }

    fn options(&self, assignment: &str, out: PathBuf) -> Result<RunOptions> {
        Ok(RunOptions {
            grade: Options {
                assignment: assignment.to_owned(),
                seed: self.seed.value()?,
                threads: 1,
                only: self.only.clone(),
                limits: self.sandbox.of_others(),
            },
            secret_seed: self.seed.is_secret(),
            jobs: self.jobs.map_or_else(rayon::current_num_threads, usize::from),
            out,
            regrade: self.regrade,
            preview: self.preview,
            pages: !self.no_report && !self.preview,
            reader: reader(),
        })
    }
}
