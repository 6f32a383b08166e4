//! The picture in a viewer, while it is rendered.

use std::time::{Duration, Instant};

use super::messages;
use super::output::mean;
use super::plan::Plan;
use super::progress::Progress;
use crate::film::Film;
use crate::image::tev::LiveView;

/// How often the viewer gets a new picture. Sending one takes milliseconds, between two passes.
const PERIOD: Duration = Duration::from_secs(1);

/// A viewer that may be there or not. Without one, rendering goes on; that it is lost is said once.
#[derive(Debug)]
pub(super) struct Live {
    view: Option<LiveView>,
    next: Instant,
}

impl Live {
    /// Connects to the viewer at the given address, if there is one.
    pub(super) fn open(address: Option<&str>, title: &str, plan: &Plan) -> Self {
        let open = |address| LiveView::open(address, title, plan.width, plan.height, &[""]);
        let view = address.and_then(|address| open(address).map_err(messages::warning).ok());
        Self { view, next: Instant::now() }
    }

    /// Shows the film, if it is time for that.
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

    /// Shows the finished film.
    pub(super) fn finish(mut self, film: &Film) {
        self.next = Instant::now();
        self.update(film, &Progress::Hidden);
    }
}
