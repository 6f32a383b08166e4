//! The grader's side of the process that runs a submission.

mod answers;
mod child;
mod expected;

use std::borrow::Cow;
use std::io::ErrorKind;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use arty::integrator::Settings;
use arty::scene::SceneDescription;
use host::protocol::{
    AuditJob, AuditedRun, DirectionJob, ProbeJob, ProbedPath, RenderJob, Rendered, ReplayJob, Replayed,
    Request, Response, SampledDirections, Switches, UNCONFINED, write_message,
};
use verdict::check::Fault;
use verdict::error::{Error, Result};
use verdict::text::clean;

use crate::build::SubmissionProgram;
use crate::job::JobError;
use crate::sandbox::{self, Account, BUSY, Layers, Profile, Watch};
use answers::{
    check_rays, check_shape, clean_words, malformed, number_of_lights, of_first_part, too_busy, unexpected,
};
use child::{describe, receive, send, spawn, started_thread};
use expected::Expected;

/// A running submission that answers jobs.
///
/// On Linux it is killed when the thread that started it ends.
pub struct HostProcess {
    child: Child,
    watch: Watch,
    requests: Sender<Vec<u8>>,
    /// Sends the reader the limits of the next answer; no answer is read before it is expected.
    expected: Sender<Expected>,
    responses: Receiver<std::io::Result<Option<Response>>>,
    /// Number of lights of each scene.
    scenes: Vec<usize>,
    job_time: Duration,
    /// Time for which the submission may wait, and for which its processes have waited.
    waiting: Duration,
    waited: Arc<Mutex<Duration>>,
    /// Processor time for all jobs together, and how much of it is left.
    all_jobs: Option<[Duration; 2]>,
    /// Scene and settings of the last job whose first part was in time.
    tried: Option<(u32, Settings)>,
    layers: Layers,
    /// True if it was ended because it took too long.
    ended: bool,
    /// Why it did not start; the answer to all jobs.
    failed: Option<Fault>,
    /// Out-of-memory kills on this machine before the process was started.
    kills: Option<u64>,
    /// User id that no other submission has while it runs.
    _account: Arc<Account>,
}

/// One in so many batches of a job is tried first, to find programs that never finish …
const FIRST_PART: usize = 8;

/// … within one in so many parts of the time: a third more than its share.
const FIRST_PART_TIME: u32 = 6;

/// Time after which it is looked again what a process does.
const TICK: Duration = Duration::from_millis(50);

/// Answer to a job.
type Answer<T> = std::result::Result<T, JobError>;

impl HostProcess {
    /// Starts the program in a sandbox, with an empty environment, in a folder of its own.
    pub fn start(program: &SubmissionProgram, threads: usize) -> Result<Self> {
        let trouble = |error: std::io::Error| {
            let denied = error.kind() == ErrorKind::PermissionDenied;
            let why = if denied {
                "; may programs be run from the folder for temporary files? set TMPDIR to one where they may"
            } else {
                ""
            };
            Error::Harness(format!("the submission's program does not start: {error}{why}"))
        };
        let limits = &program.limits;
        let mut command = Command::new(&program.executable);
        command
            .args((!limits.sandbox).then_some(UNCONFINED))
            .env_clear()
            .env("RAYON_NUM_THREADS", threads.to_string())
            .current_dir(program.executable.parent().unwrap_or(&program.executable))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            // What a submission prints is nobody's verdict.
            .stderr(Stdio::null());
        let account = Arc::clone(program.account());
        let profile = Profile::Host { program: &program.executable, account: &account, threads };
        let set = sandbox::prepare(&mut command, profile, limits)?;
        let kills = sandbox::out_of_memory_kills();
        let mut child = spawn(&mut command).map_err(trouble)?;
        let layers = sandbox::confirmed(&child, set);
        let requests = send(child.stdin.take().expect("stdin is piped"));
        let (expected, responses) = receive(child.stdout.take().expect("stdout is piped"));
        let job_time = limits.job_time;
        let mut process = Self {
            watch: Watch::start(&child),
            child,
            requests,
            expected,
            responses,
            scenes: Vec::new(),
            job_time,
            waiting: limits.waiting,
            waited: Arc::clone(program.waited()),
            all_jobs: None,
            tried: None,
            layers,
            ended: false,
            failed: None,
            kills,
            _account: account,
        };
        let _ = process.expected.send(Expected::start());
        process.failed = match process.answer(job_time).0 {
            Ok(Response::Started) => None,
            Ok(_) => Some(Fault::Malformed("it did not report that it has started".to_owned())),
            Err(JobError::Submission(fault)) => Some(fault),
            Err(JobError::Harness(error)) => return Err(error),
        };
        Ok(process)
    }

    /// Why the program did not start; `None` if it did. All of its jobs end with the same fault.
    ///
    /// The [`trial`](crate::trial) has shown that programs start on this machine, so this is a fault of the submission.
    pub fn fault(&self) -> Option<&Fault> {
        self.failed.as_ref()
    }

    /// Limits the processor time for all further jobs together.
    #[must_use]
    pub fn within(mut self, time: Duration) -> Self {
        self.all_jobs = Some([time; 2]);
        self
    }

    /// Sandbox layers of the process: those that the grader set before the program started and that the kernel confirms.
    /// The process itself has no influence on them.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// Sends a scene and returns the number by which jobs refer to it.
    pub fn load(&mut self, scene: &SceneDescription) -> Answer<u32> {
        self.load_with(scene, Switches::default())
    }

    /// Sends a scene with switches and returns the number by which jobs refer to it.
    pub fn load_with(&mut self, scene: &SceneDescription, switches: Switches) -> Answer<u32> {
        match self.ask(&Request::Scene(Cow::Borrowed(scene), switches), self.job_time)? {
            Response::SceneReady => {
                self.scenes.push(number_of_lights(scene));
                Ok(self.scenes.len() as u32 - 1)
            }
            other => Err(unexpected(other)),
        }
    }

    /// Renders batches. There are as many as the job asks for, and all means are finite.
    ///
    /// Unless the last job had the same scene and settings, an eighth of the batches is rendered first: if even these take
    /// too long, the rest is not tried. Jobs of fewer than eight batches are not divided.
    pub fn render(&mut self, job: &RenderJob) -> Answer<Rendered> {
        let place = Some((job.scene, job.settings));
        let first = if self.tried == place { 0 } else { job.seeds.len() / FIRST_PART };
        if first == 0 {
            return self.render_in_time(job, self.job_time);
        }
        let part = |seeds: &[u64]| RenderJob { seeds: seeds.to_vec(), ..job.clone() };
        let (first, rest) = job.seeds.split_at(first);
        let time = self.job_time / FIRST_PART_TIME;
        let mut rendered =
            self.render_in_time(&part(first), time).map_err(|error| of_first_part(error, time))?;
        self.tried = place;
        rendered.append(self.render_in_time(&part(rest), self.job_time)?);
        Ok(rendered)
    }

    fn render_in_time(&mut self, job: &RenderJob, time: Duration) -> Answer<Rendered> {
        let lights = self.lights(job.scene)?;
        let (pixels, batches) = (job.width as usize * job.height as usize, job.seeds.len());
        match self.ask(&Request::Render(Cow::Borrowed(job)), time)? {
            Response::Rendered(rendered) => {
                Ok(check_rays(check_shape(rendered, batches, pixels)?, job, lights)?)
            }
            other => Err(unexpected(other)),
        }
    }

    /// Traces paths through scripted scenes, as many per scene as the job asks for. Their radiance is not checked.
    ///
    /// An eighth of them is traced first, to find programs that never finish.
    pub fn probe(&mut self, job: &ProbeJob) -> Answer<Vec<Vec<ProbedPath>>> {
        let first = job.samples / FIRST_PART as u64;
        if first > 0 {
            let (job, time) = (ProbeJob { samples: first, ..job.clone() }, self.job_time / FIRST_PART_TIME);
            self.probe_in_time(&job, time).map_err(|error| of_first_part(error, time))?;
        }
        self.probe_in_time(job, self.job_time)
    }

    fn probe_in_time(&mut self, job: &ProbeJob, time: Duration) -> Answer<Vec<Vec<ProbedPath>>> {
        if job.stratified && !(job.samples.is_power_of_two() && job.samples <= 1 << 20) {
            return Err(Error::Harness(format!("{} paths cannot be stratified", job.samples)).into());
        }
        match self.ask(&Request::Probe(Cow::Borrowed(job)), time)? {
            Response::Probed(paths) => {
                let is_whole = paths.len() == job.scenes.len()
                    && paths.iter().all(|paths| paths.len() as u64 == job.samples);
                if is_whole { Ok(paths) } else { Err(malformed("the number of scenes or paths is wrong")) }
            }
            other => Err(unexpected(other)),
        }
    }

    /// Makes the runs of an audit within `time`. Their numbers are not checked.
    pub fn audit(&mut self, job: &AuditJob, time: Duration) -> Answer<Vec<AuditedRun>> {
        if !job.is_valid() {
            return Err(Error::Harness("an audit's run cannot be made".to_owned()).into());
        }
        match self.ask(&Request::Audit(Cow::Borrowed(job)), time.min(self.job_time))? {
            Response::Audited(runs) if runs.len() == job.runs.len() => Ok(runs),
            Response::Audited(_) => Err(malformed("the number of runs is wrong")),
            other => Err(unexpected(other)),
        }
    }

    /// Samples directions of a scene's environment. There are as many answers as the job asks for; their numbers are not
    /// checked.
    pub fn directions(&mut self, job: &DirectionJob) -> Answer<SampledDirections> {
        self.lights(job.scene)?;
        match self.ask(&Request::Directions(Cow::Borrowed(job)), self.job_time)? {
            Response::Directions(sampled)
                if sampled.samples.len() == job.samples as usize
                    && sampled.densities.len() == job.directions.len() =>
            {
                Ok(sampled)
            }
            Response::Directions(_) => Err(malformed("the number of directions is wrong")),
            other => Err(unexpected(other)),
        }
    }

    /// Traces one path again and records every call. Numbers are not checked; texts are made harmless.
    pub fn replay(&mut self, job: ReplayJob) -> Answer<Replayed> {
        self.lights(job.scene)?;
        match self.ask(&Request::Replay(job), self.job_time)? {
            Response::Replayed(path) => Ok(clean_words(path)),
            other => Err(unexpected(other)),
        }
    }

    /// Number of lights of a scene. Checks a job for mistakes of the grader's own, so that a rejection by the process is a
    /// fault of the submission.
    fn lights(&self, scene: u32) -> Result<usize> {
        self.scenes.get(scene as usize).copied().ok_or_else(|| {
            Error::Harness(format!("there is no scene {scene}: {} were sent", self.scenes.len()))
        })
    }

    fn ask(&mut self, request: &Request<'_>, time: Duration) -> Answer<Response> {
        if let Some(fault) = &self.failed {
            return Err(fault.clone().into());
        }
        let mut bytes = Vec::new();
        write_message(&mut bytes, request)
            .map_err(|error| Error::Harness(format!("a job cannot be sent: {error}")))?;
        // If nobody takes it any more, there will be no answer either.
        let _ = self.expected.send(Expected::answer_to(request));
        let _ = self.requests.send(bytes);
        let Some([all, left]) = self.all_jobs else { return self.answer(time).0 };
        let (answer, computed) = self.answer(time.min(left));
        self.all_jobs = Some([all, left.saturating_sub(computed)]);
        answer.map_err(|error| match error {
            JobError::Submission(Fault::Timeout(_)) if left < time => {
                Fault::Timeout(all.as_secs_f64()).into()
            }
            error => error,
        })
    }

    /// Waits for the next message until the process has used `time` on processors, or has waited too long itself. Also
    /// returns the processor time that it has used.
    fn answer(&mut self, time: Duration) -> (Answer<Response>, Duration) {
        self.watch.next(&self.child);
        let earlier = *self.waited.lock().unwrap_or_else(PoisonError::into_inner);
        let may_wait = (self.waiting / 2).min(self.waiting.saturating_sub(earlier));
        loop {
            let said = self.responses.recv_timeout(TICK);
            let spent = self.watch.spent(&self.child);
            let fault = match said {
                Err(RecvTimeoutError::Timeout) if spent.computed >= time => {
                    Fault::Timeout(time.as_secs_f64())
                }
                Err(RecvTimeoutError::Timeout) if spent.waited >= may_wait => {
                    Fault::Waiting(spent.waited.as_secs_f64().round())
                }
                Err(RecvTimeoutError::Timeout) if spent.wall >= self.job_time * BUSY => {
                    return (Err(too_busy(spent.wall).into()), spent.computed);
                }
                Err(RecvTimeoutError::Timeout) => continue,
                said => {
                    self.count_waiting(spent.waited);
                    return (self.said(said), spent.computed);
                }
            };
            self.count_waiting(spent.waited);
            sandbox::end(&mut self.child);
            self.ended = true;
            return (Err(fault.into()), spent.computed);
        }
    }

    /// Adds to the time for which the submission has waited.
    fn count_waiting(&self, waited: Duration) {
        *self.waited.lock().unwrap_or_else(PoisonError::into_inner) += waited;
    }

    fn said(
        &mut self,
        said: std::result::Result<std::io::Result<Option<Response>>, RecvTimeoutError>,
    ) -> Answer<Response> {
        match said {
            Ok(Ok(Some(response))) => Ok(response),
            Ok(Err(error)) if error.kind() != ErrorKind::UnexpectedEof => {
                Err(malformed(&clean(&error.to_string())))
            }
            _ => Err(self.crash()?.into()),
        }
    }

    /// The fault of a process that has ended by itself.
    fn crash(&mut self) -> Result<Fault> {
        // The pipe may close a moment before the process is gone.
        std::thread::sleep(Duration::from_millis(20));
        if let Ok(Some(status)) = self.child.try_wait()
            && !self.ended
        {
            sandbox::blame_machine(status, self.kills, "the submission's program")?;
        }
        sandbox::end(&mut self.child);
        Ok(match self.child.wait() {
            Ok(status) if started_thread(status) => Fault::Threads,
            Ok(status) => Fault::Crash(describe(status)),
            Err(error) => Fault::Crash(error.to_string()),
        })
    }
}

impl Drop for HostProcess {
    fn drop(&mut self) {
        sandbox::end(&mut self.child);
        let _ = self.child.wait();
    }
}
