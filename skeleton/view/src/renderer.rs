//! The thread that renders: it takes the latest view, and refines its picture until there is another one.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use arty::scene::{Scene, SceneDescription};

use crate::orders::{Next, Orders, Save};
use crate::part::{Part, Picture, Studio};
use crate::reference::Reference;
use crate::save::save;
use crate::schedule::{self, Pass, Speed};
use crate::view::{Balance, Make, View};

/// What stays the same while a window is open.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene as data, for metadata of saved files.
    pub description: Arc<SceneDescription>,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of samples per pixel at which rendering ends; `None` for no end.
    pub samples: Option<u64>,
    /// Number of threads; 0 for one per processor.
    pub threads: usize,
    /// The reference, of the same size.
    pub reference: Option<Arc<Reference>>,
}

/// What the renderer has to show.
#[derive(Clone, Debug)]
pub enum News {
    /// The picture has changed.
    Frame,
    /// Files were written, or why not.
    Saved(Result<String, String>),
    /// The algorithm has panicked, and its picture ends here.
    Panicked,
}

/// The pictures of a view at some time of their refinement.
#[derive(Clone, Debug)]
pub struct Frame {
    /// What they show.
    pub view: View,
    /// One picture, or two for a wipe between two algorithms.
    pub pictures: Vec<Picture>,
}

/// A thread that renders the latest view. It ends when this is dropped, after the pass that is being rendered.
pub struct Renderer {
    orders: Arc<Orders>,
    frame: Arc<Mutex<Option<Arc<Frame>>>>,
    thread: Option<JoinHandle<()>>,
}

impl Renderer {
    /// Starts to render. `tell` is called on the thread that renders.
    ///
    /// # Errors
    ///
    /// If the threads cannot be started.
    pub fn start(
        scene: Arc<Scene>,
        make: Make,
        setup: Setup,
        view: View,
        tell: impl Fn(News) + Send + 'static,
    ) -> Result<Self, String> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(setup.threads).build();
        let pool = pool.map_err(|error| format!("could not start the render threads: {error}"))?;
        let (orders, frame) = (Arc::new(Orders::new(view)), Arc::new(Mutex::new(None)));
        let (for_thread, shown) = (Arc::clone(&orders), Arc::clone(&frame));
        let publish = move |news: News, latest: Option<Frame>| {
            if let Some(latest) = latest {
                *shown.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(latest));
            }
            tell(news);
        };
        let work =
            move || Worker { scene, make, setup, pool, speed: Speed::default(), publish }.run(&for_thread);
        let thread = std::thread::Builder::new().name("renderer".to_owned()).spawn(work);
        let thread = thread.map_err(|error| format!("could not start the renderer: {error}"))?;
        Ok(Self { orders, frame, thread: Some(thread) })
    }

    /// Shows another view as soon as possible.
    pub fn show(&self, view: View) {
        self.orders.show(view);
    }

    /// Stops refining, or goes on.
    pub fn pause(&self, paused: bool) {
        self.orders.pause(paused);
    }

    /// Saves the pictures as they are.
    pub fn save(&self, save: Save) {
        self.orders.save(save);
    }

    /// The latest pictures; `None` before the first.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        self.frame.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        self.orders.quit();
        if let Some(thread) = self.thread.take() {
            // It has told of its panics.
            let _ = thread.join();
        }
    }
}

struct Worker<Publish> {
    scene: Arc<Scene>,
    make: Make,
    setup: Setup,
    pool: rayon::ThreadPool,
    speed: Speed,
    publish: Publish,
}

impl<Publish: Fn(News, Option<Frame>)> Worker<Publish> {
    fn run(mut self, orders: &Orders) {
        let (mut view, mut number) = (None, 0);
        let mut parts: Vec<Part> = Vec::new();
        let mut panicked = false;
        loop {
            let has_samples = !parts.is_empty() && parts.iter().all(|part| part.progress().samples > 0);
            let due = view.and_then(|view| self.due(&view, &parts));
            match orders.next(number, has_samples, panicked || due.is_none()) {
                Next::Quit => return,
                Next::Save(order) => {
                    let saved =
                        view.map_or(Ok(String::new()), |view| save(&order, &self.setup, &view, &parts));
                    (self.publish)(News::Saved(saved), None);
                }
                Next::Begin(new, new_number) => {
                    (view, number, panicked) = (Some(new), new_number, false);
                    let (width, height) = (self.setup.width, self.setup.height);
                    let part =
                        |algorithm| Part::new(algorithm, (self.make)(algorithm, &self.scene), width, height);
                    parts = new.algorithms().into_iter().map(part).collect();
                }
                Next::Refine => {
                    let (Some(view), Some((part, pass))) = (view, due) else { continue };
                    panicked = self.refine(&view, &mut parts, part, &pass, orders);
                }
            }
        }
    }

    /// Renders a pass of one part and publishes the pictures. True if the algorithm has panicked.
    fn refine(&mut self, view: &View, parts: &mut [Part], part: usize, pass: &Pass, orders: &Orders) -> bool {
        // The first picture of a view is always completed: while the camera keeps moving, there would be none at all.
        let never = AtomicBool::new(false);
        let progress = parts[part].progress();
        let is_first = progress.coarse.is_none() && progress.samples == 0;
        let stop = if is_first { &never } else { &orders.stop };
        let studio = Studio { scene: &self.scene, pool: &self.pool, seed: self.setup.seed };
        let rendering = catch_unwind(AssertUnwindSafe(|| {
            parts[part].render(&studio, &view.camera, pass, &mut self.speed, stop);
        }));
        if rendering.is_err() {
            (self.publish)(News::Panicked, None);
            return true;
        }
        let stopped = stop.load(Ordering::Relaxed);
        let level = view.balance == Balance::EqualTime
            || parts.iter().all(|other| other.progress().samples == parts[0].progress().samples);
        if !stopped && level {
            // From another camera, the reference shows something else.
            let is_comparable = view.camera == self.setup.description.camera;
            let reference = self.setup.reference.as_deref().filter(|_| is_comparable);
            let pictures: Vec<Picture> = parts.iter().filter_map(|part| part.picture(reference)).collect();
            if pictures.len() == parts.len() {
                (self.publish)(News::Frame, Some(Frame { view: *view, pictures }));
            }
        }
        false
    }

    /// The part that is behind, and its next pass; `None` when all have as many samples as asked for.
    fn due(&self, view: &View, parts: &[Part]) -> Option<(usize, Pass)> {
        let pixels = u64::from(self.setup.width) * u64::from(self.setup.height);
        // Two pictures share the time of one.
        let work = pixels * parts.len() as u64;
        let next = |part: &Part, limit| schedule::next(part.progress(), work, self.speed, limit);
        let fineness = |part: &Part| part.progress().coarse.map_or(0, |divisor| u32::MAX / divisor);
        let behind = |part: &&(usize, &Part)| {
            let progress = part.1.progress();
            match view.balance {
                // As long as one is coarse, the coarser one comes first.
                _ if parts.iter().any(|part| part.progress().samples == 0) => {
                    (Duration::ZERO, progress.samples.min(1), fineness(part.1))
                }
                Balance::EqualSamples => (Duration::ZERO, progress.samples, 0),
                Balance::EqualTime => (part.1.time(), 0, 0),
            }
        };
        let open = parts.iter().enumerate().filter(|(_, part)| next(part, self.setup.samples).is_some());
        let open: Vec<(usize, &Part)> = open.collect();
        let (index, part) = open.iter().min_by_key(behind)?;
        // With equal samples, the one that is behind catches up exactly.
        let ahead = parts.iter().map(|part| part.progress().samples).max().unwrap_or(0);
        let catches_up = view.balance == Balance::EqualSamples && part.progress().samples < ahead;
        match next(part, self.setup.samples)? {
            Pass::Samples(range) if catches_up => Some((*index, Pass::Samples(range.start..ahead))),
            pass => Some((*index, pass)),
        }
    }
}
