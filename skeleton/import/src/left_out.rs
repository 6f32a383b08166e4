//! What was not converted.

/// What has no counterpart in the renderer, in the order in which it was met.
#[derive(Debug, Default)]
pub(crate) struct LeftOut(Vec<String>);

impl LeftOut {
    /// Adds an item; each is listed once.
    pub(crate) fn add(&mut self, what: impl Into<String>) {
        let what = what.into();
        if !self.0.contains(&what) {
            self.0.push(what);
        }
    }

    /// Adds an item if the condition holds.
    pub(crate) fn add_if(&mut self, condition: bool, what: impl FnOnce() -> String) {
        if condition {
            self.add(what());
        }
    }

    /// All items.
    pub(crate) fn into_vec(self) -> Vec<String> {
        self.0
    }
}
