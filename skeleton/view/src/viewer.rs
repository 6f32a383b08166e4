//! The state of the window, without the window: what keys and mouse change.

use arty::camera::CameraDescription;
use arty::cli::{Algorithm, DebugView};
use arty::integrator::{Settings, Technique};

use crate::camera::CameraControl;
use crate::keys::{Action, Key, action};
use crate::look::Look;
use crate::path::{Query, Traced};
use crate::pointer::{Gesture, Pointer};
use crate::view::{Against, Balance, View};

/// Largest exposure in stops, of either sign.
const MAX_EXPOSURE: f32 = 100.0;

/// The state of the window.
#[derive(Clone, Debug)]
pub struct Viewer {
    /// The camera.
    pub camera: CameraControl,
    /// Technique and maximum number of bounces of the path tracer.
    pub settings: Settings,
    /// The property of surfaces that is shown; `None` for radiance.
    pub shown: Option<DebugView>,
    /// Exposure and tone map.
    pub look: Look,
    /// True if the picture is not refined.
    pub paused: bool,
    /// True if the keys are shown.
    pub help: bool,
    /// What the right part shows; `None` without a wipe.
    pub wipe: Option<Right>,
    /// How the two parts of a wipe share the time.
    pub balance: Balance,
    /// Where the right part of a wipe begins: fraction of the width.
    pub divider: f32,
    /// The paths to show; `None` if none are.
    pub query: Option<Query>,
    /// The paths that were traced last.
    pub traced: Option<Traced>,
    /// True if the numbers of the chosen path are shown, too.
    pub numbers: bool,
    /// A line about what was done last.
    pub message: Option<String>,
    has_reference: bool,
    size: (u32, u32),
    pointer: Pointer,
}

/// What the right part of a wipe shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Right {
    /// The same picture by another technique.
    Technique(Technique),
    /// The reference.
    Reference,
}

/// What the window has to do after an input, other than to show the new state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Save the picture.
    Save,
    /// Print the camera.
    PrintCamera,
}

impl Viewer {
    /// The state in the beginning, for a picture of the given size in pixels.
    pub fn new(camera: CameraDescription, settings: Settings, size: (u32, u32), has_reference: bool) -> Self {
        Self {
            camera: CameraControl::new(camera),
            settings,
            shown: None,
            look: Look { exposure: 0.0, tone_map: crate::look::ToneMap::Clamp },
            paused: false,
            help: false,
            wipe: None,
            balance: Balance::EqualSamples,
            divider: 0.5,
            query: None,
            traced: None,
            numbers: true,
            message: None,
            has_reference,
            size,
            pointer: Pointer::default(),
        }
    }

    /// Width and height of the picture in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// What is to be rendered.
    pub fn view(&self) -> View {
        let against = self.wipe.map(|right| match right {
            Right::Technique(technique) => Against::Algorithm(self.algorithm(technique)),
            Right::Reference => Against::Reference,
        });
        let algorithm = self.algorithm(self.settings.technique);
        View { camera: self.camera.now(), algorithm, against, balance: self.balance }
    }

    fn algorithm(&self, technique: Technique) -> Algorithm {
        match self.shown {
            Some(property) => Algorithm::Debug(property),
            None => Algorithm::PathTracer(Settings { technique, ..self.settings }),
        }
    }

    /// A key was pressed.
    pub fn key(&mut self, key: Key) -> Option<Effect> {
        self.message = None;
        self.act(action(key)?)
    }

    /// The mouse did something.
    pub fn mouse(&mut self, gesture: Gesture) {
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        match gesture {
            Gesture::Orbit(x, y) => self.camera.orbit(-180.0 * x / width, 180.0 * y / width),
            Gesture::Pan(x, y) => self.camera.pan(-x / width, y / width),
            Gesture::Zoom(steps) => self.camera.zoom(steps),
            Gesture::Divider(x) => self.divider = (x / width).clamp(0.0, 1.0),
            Gesture::Click(x, y) => {
                if (0.0..width).contains(&x) && (0.0..height).contains(&y) {
                    self.ask_for_paths(x, y);
                }
            }
        }
    }

    /// What follows the mouse while a button is pressed. Needs to know where the divider is.
    pub fn pointer(&mut self) -> (&mut Pointer, Option<f32>) {
        let divider = self.wipe.map(|_| self.divider * self.size.0 as f32);
        (&mut self.pointer, divider)
    }

    fn act(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Orbit(right, up) => self.camera.orbit(right, up),
            Action::Walk(right, up, forward) => self.camera.walk(right, up, forward),
            Action::Home => self.camera.home(),
            Action::NextTechnique => self.settings.technique = next(self.settings.technique),
            Action::Technique(technique) => self.settings.technique = technique,
            Action::Bounces(more) => {
                self.settings.max_bounces = self.settings.max_bounces.saturating_add_signed(more);
            }
            Action::Exposure(stops) => {
                self.look.exposure = (self.look.exposure + stops).clamp(-MAX_EXPOSURE, MAX_EXPOSURE);
                self.message = Some(format!("exposure {:+} EV", self.look.exposure));
            }
            Action::NoExposure => self.look.exposure = 0.0,
            Action::ToneMap => {
                self.look.tone_map = self.look.tone_map.next();
                self.message = Some(format!("tone map: {}", self.look.tone_map.name()));
            }
            Action::Show(property) => {
                self.shown = if self.shown == Some(property) { None } else { Some(property) };
            }
            Action::Save => return Some(Effect::Save),
            Action::Pause => self.paused = !self.paused,
            Action::Help => self.help = !self.help,
            Action::PrintCamera => return Some(Effect::PrintCamera),
            Action::Wipe => self.next_wipe(),
            Action::NextRight => self.next_right(),
            Action::Balance => {
                self.balance = match self.balance {
                    Balance::EqualSamples => Balance::EqualTime,
                    Balance::EqualTime => Balance::EqualSamples,
                }
            }
            Action::Step(by) => {
                if let Some(query) = &mut self.query {
                    query.sample = query.sample.saturating_add_signed(by);
                }
            }
            Action::Brightest => self.go_to_brightest(),
            Action::Numbers => self.numbers = !self.numbers,
            Action::Close => self.close(),
        }
        // A technique chosen for the left part must not be that of the right one, too.
        if self.wipe == Some(Right::Technique(self.settings.technique)) {
            self.wipe = Some(Right::Technique(next(self.settings.technique)));
        }
        None
    }

    /// Off, against a technique, against the reference if there is one, off.
    fn next_wipe(&mut self) {
        let left = self.settings.technique;
        self.wipe = match self.wipe {
            None if left == Technique::Mis => Some(Right::Technique(Technique::Nee)),
            None => Some(Right::Technique(Technique::Mis)),
            Some(Right::Technique(_)) if self.has_reference => Some(Right::Reference),
            Some(_) => None,
        };
    }

    fn next_right(&mut self) {
        if let Some(Right::Technique(technique)) = self.wipe {
            self.wipe = Some(Right::Technique(next(technique)));
        }
    }

    fn ask_for_paths(&mut self, x: f32, y: f32) {
        let view = self.view();
        let is_right = x >= self.divider * self.size.0 as f32;
        let algorithm = match view.against {
            Some(Against::Algorithm(right)) if is_right => right,
            _ => view.algorithm,
        };
        // Properties of surfaces have no paths.
        if let Algorithm::PathTracer(settings) = algorithm {
            let pixel = (x as u32, y as u32);
            self.query = Some(Query { camera: view.camera, settings, pixel, sample: 0 });
        } else {
            self.message = Some("paths are those of the path tracer: press n or l again".to_owned());
        }
    }

    /// Takes paths that were traced, unless others are asked for by now.
    pub fn take(&mut self, traced: Traced) {
        if self.query == Some(traced.query) {
            self.traced = Some(traced);
        }
    }

    /// The paths to draw.
    pub fn paths(&self) -> Option<&Traced> {
        self.query.and(self.traced.as_ref())
    }

    fn go_to_brightest(&mut self) {
        let brightest = self.paths().and_then(Traced::brightest);
        if let (Some(query), Some(sample)) = (&mut self.query, brightest) {
            query.sample = sample;
        }
    }

    fn close(&mut self) {
        if self.query.take().is_some() {
            self.traced = None;
        } else if self.help {
            self.help = false;
        } else {
            self.wipe = None;
        }
    }
}

fn next(technique: Technique) -> Technique {
    match technique {
        Technique::Bsdf => Technique::Nee,
        Technique::Nee => Technique::Mis,
        Technique::Mis => Technique::Bsdf,
    }
}

#[cfg(test)]
mod tests;
