//! What the window asks of the thread that renders.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

use crate::view::View;

/// The latest wishes of the window. Later ones replace earlier ones, so that the picture never lags behind the input.
#[derive(Debug)]
pub(crate) struct Orders {
    latest: Mutex<Latest>,
    changed: Condvar,
    /// True if the pass that is being rendered is not wanted any more.
    pub(crate) stop: AtomicBool,
}

#[derive(Clone, Debug)]
struct Latest {
    view: View,
    /// Number of views so far.
    number: u64,
    paused: bool,
    save: Option<Save>,
    quit: bool,
}

/// Files to write.
#[derive(Clone, Debug, PartialEq)]
pub struct Save {
    /// Folder and beginning of the file names, to which technique and extension are added.
    pub stem: PathBuf,
    /// How the PNG shows the picture.
    pub look: crate::look::Look,
}

/// What to do next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Next {
    /// Begin with another view.
    Begin(View, u64),
    /// Go on with the present one.
    Refine,
    /// Write files.
    Save(Save),
    /// End the thread.
    Quit,
}

impl Orders {
    pub(crate) fn new(view: View) -> Self {
        let latest = Latest { view, number: 1, paused: false, save: None, quit: false };
        Self { latest: Mutex::new(latest), changed: Condvar::new(), stop: AtomicBool::new(false) }
    }

    fn change(&self, change: impl FnOnce(&mut Latest)) {
        change(&mut self.latest.lock().unwrap_or_else(PoisonError::into_inner));
        self.changed.notify_one();
    }

    /// Asks for another view. Passes of the last one stop.
    pub(crate) fn show(&self, view: View) {
        self.change(|latest| {
            (latest.view, latest.number) = (view, latest.number + 1);
            self.stop.store(true, Ordering::Relaxed);
        });
    }

    /// Stops after the present pass, or goes on. A new view still gets its first picture.
    pub(crate) fn pause(&self, paused: bool) {
        self.change(|latest| latest.paused = paused);
    }

    pub(crate) fn save(&self, save: Save) {
        self.change(|latest| latest.save = Some(save));
    }

    pub(crate) fn quit(&self) {
        self.change(|latest| {
            latest.quit = true;
            self.stop.store(true, Ordering::Relaxed);
        });
    }

    /// What to do next, given the view that is being rendered and whether it has a sample for all pixels, and whether it
    /// is finished. Waits while there is nothing to do.
    pub(crate) fn next(&self, number: u64, has_samples: bool, finished: bool) -> Next {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if latest.quit {
                return Next::Quit;
            }
            if latest.number != number {
                self.stop.store(false, Ordering::Relaxed);
                return Next::Begin(latest.view, latest.number);
            }
            if let Some(save) = latest.save.take() {
                return Next::Save(save);
            }
            let rests = finished || latest.paused && has_samples;
            if !rests {
                return Next::Refine;
            }
            latest = self.changed.wait(latest).unwrap_or_else(PoisonError::into_inner);
        }
    }
}
