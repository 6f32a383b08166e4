//! The image in a viewer during rendering.

use std::time::{Duration, Instant};

use super::messages;
use super::output::mean;
use super::plan::Plan;
use super::progress::Progress;
use crate::film::Film;
use crate::image::tev::LiveView;

/// Interval between updates. Sending an image takes some milliseconds between two passes.
const PERIOD: Duration = Duration::from_secs(1);

/// A viewer that may be absent. Losing it is reported once and does not stop rendering.
#[derive(Debug)]
pub(super) struct Live {
    view: Option<LiveView>,
    next: Instant,
}

impl Live {
    /// Connects to the viewer at the given address; without an address there is none.
    pub(super) fn open(address: Option<&str>, title: &str, plan: &Plan) -> Self {
        let open = |address| LiveView::open(address, title, plan.width, plan.height, &[""]);
        let view = address.and_then(|address| open(address).map_err(messages::warning).ok());
        Self { view, next: Instant::now() }
    }

    /// Sends the film if an update is due.
    pub(super) fn update(&mut self, film: &Film, progress: &Progress) {
        if Instant::now() < self.next {
            return;
        }
        if let Some(view) = &mut self.view
            && let Err(lost) = view.show("", &mean(film))
        {
            progress.interject(|| messages::warning(lost));
            self.view = None;
        }
        self.next = Instant::now() + PERIOD;
    }

    /// Sends the finished film.
    pub(super) fn finish(mut self, film: &Film) {
        self.next = Instant::now();
        self.update(film, &Progress::Hidden);
    }
}
