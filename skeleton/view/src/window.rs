//! The window: passes on what keys and mouse do, and shows the result.

mod events;
mod restart;

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use arty::scene::Scene;
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use crate::args::{Args, Place};
use crate::canvas::Canvas;
use crate::orders::Save;
use crate::paint::{Shown, paint};
use crate::path::trace::trace;
use crate::path::{Query, Traced};
use crate::program::{Failure, Program};
use crate::reload::{self, Reload};
use crate::renderer::{News, Renderer, Setup};
use crate::title::title;
use crate::view::View;
use crate::viewer::{Effect, Viewer};

/// Width in pixels up to which small pictures are shown larger.
const LEGIBLE: u32 = 640;

/// What a window shows.
pub(crate) struct Content {
    pub(crate) program: Program,
    pub(crate) args: Args,
    pub(crate) scene: Arc<Scene>,
    pub(crate) setup: Setup,
    pub(crate) viewer: Viewer,
}

/// What other threads have to say.
enum Message {
    Renderer(News),
    Traced(Box<Traced>),
    Reload(Reload),
}

/// Opens a window, and returns when it is closed.
pub(crate) fn open(content: Content) -> Result<(), Failure> {
    // The reason that winit gives is a place in its own source.
    let events = EventLoop::<Message>::with_user_event().build().map_err(|_| {
        Failure::Refused(format!(
            "cannot open a window: no display can be reached. Render to a file with `cargo arty {} --output=FILE.png`, or show \
             the picture in the viewer tev with --tev=HOST:PORT",
            content.args.scene.display()
        ))
    })?;
    let mut shell = Shell::new(content, &events)?;
    events.run_app(&mut shell).map_err(|error| Failure::Broken(format!("the window broke: {error}")))?;
    shell.failure.take().map_or(Ok(()), Err)
}

struct Shell {
    content: Content,
    renderer: Renderer,
    proxy: EventLoopProxy<Message>,
    screen: Option<Screen>,
    /// For each light whether it has an area.
    lights: Vec<bool>,
    view: View,
    paused: bool,
    query: Option<Query>,
    /// Messages of the compiler or of a panic.
    trouble: Option<String>,
    shift: bool,
    failure: Option<Failure>,
}

/// A window and the pixels in it.
struct Screen {
    window: Rc<Window>,
    surface: softbuffer::Surface<Rc<Window>, Rc<Window>>,
}

impl Shell {
    fn new(content: Content, events: &EventLoop<Message>) -> Result<Self, Failure> {
        let proxy = events.create_proxy();
        let (view, sender) = (content.viewer.view(), proxy.clone());
        // A window that is gone needs no news.
        let tell = move |news| drop(sender.send_event(Message::Renderer(news)));
        restart::keep_first_panic();
        let (scene, make, setup) = (Arc::clone(&content.scene), content.program.make, content.setup.clone());
        let renderer = Renderer::start(scene, make, setup, view, tell).map_err(Failure::Broken)?;
        if content.args.watch {
            let sender = proxy.clone();
            let tell = move |reload| sender.send_event(Message::Reload(reload)).is_ok();
            reload::watch(content.program.source.into(), content.program.build(), tell);
        }
        let lights = content.scene.lights().iter().map(|light| light.has_area()).collect();
        let (paused, query, trouble) = (false, None, None);
        let shell = Self {
            content,
            renderer,
            proxy,
            screen: None,
            lights,
            view,
            paused,
            query,
            trouble,
            shift: false,
            failure: None,
        };
        Ok(shell)
    }

    /// Does what follows from a change of the state: another picture, other paths, another title.
    fn update(&mut self) {
        let viewer = &self.content.viewer;
        let view = viewer.view();
        if view != self.view {
            self.view = view;
            self.trouble = None;
            self.renderer.show(view);
        }
        if viewer.paused != self.paused {
            self.paused = viewer.paused;
            self.renderer.pause(self.paused);
        }
        if viewer.query != self.query {
            self.query = viewer.query;
            self.query.into_iter().for_each(|query| self.trace(query));
        }
        self.show();
    }

    /// Traces paths on a thread of their own: an algorithm that never ends must not block the window.
    fn trace(&self, query: Query) {
        let (scene, make, sender) =
            (Arc::clone(&self.content.scene), self.content.program.make, self.proxy.clone());
        let (size, seed) = (self.content.viewer.size(), self.content.setup.seed);
        std::thread::spawn(move || {
            let traced = Box::new(trace(&scene, make, &query, size, seed));
            drop(sender.send_event(Message::Traced(traced)));
        });
    }

    fn show(&self) {
        if let Some(screen) = &self.screen {
            let frame = self.renderer.frame();
            screen.window.set_title(&title(&self.scene_name(), &self.content.viewer, frame.as_deref()));
            screen.window.request_redraw();
        }
    }

    fn paint(&mut self) {
        let Some(Screen { window, surface }) = &mut self.screen else { return };
        let size = window.inner_size();
        let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) else {
            return;
        };
        let drawn = surface.resize(width, height).and_then(|()| {
            let mut pixels = surface.buffer_mut()?;
            let frame = self.renderer.frame();
            let (width, height) = (size.width as usize, size.height as usize);
            let mut canvas = Canvas { pixels: &mut pixels, width, height };
            let shown = Shown {
                frame: frame.as_deref(),
                reference: self.content.setup.reference.as_deref(),
                lights: &self.lights,
                failure: self.trouble.as_deref(),
            };
            paint(&mut canvas, &self.content.viewer, &shown);
            pixels.present()
        });
        if let Err(error) = drawn {
            self.trouble = Some(format!("the window cannot be drawn: {error}"));
        }
    }

    fn follow(&mut self, effect: Effect) {
        match effect {
            Effect::PrintCamera => {
                println!("{}", self.content.viewer.camera.yaml());
                self.content.viewer.message = Some("the camera was printed to the terminal".to_owned());
            }
            Effect::Save => {
                let stem = PathBuf::from(self.scene_name());
                self.renderer.save(Save { stem, look: self.content.viewer.look });
            }
        }
    }

    /// The name of the scene file without its folder and extension.
    fn scene_name(&self) -> String {
        let stem = self.content.args.scene.file_stem().unwrap_or_else(|| Path::new("scene").as_os_str());
        stem.to_string_lossy().into_owned()
    }

    fn reload(&mut self, reload: Reload) {
        self.trouble = match reload {
            Reload::Compiling => Some("compiling ...".to_owned()),
            Reload::Failed(messages) => Some(messages),
            Reload::Ready => Some(restart::restart(&self.args_now())),
        };
    }

    /// The arguments with which a new process shows the same.
    fn args_now(&self) -> Args {
        let Content { args, viewer, .. } = &self.content;
        let place = self.screen.as_ref().map(|Screen { window, .. }| {
            let (size, corner) = (window.inner_size(), window.outer_position().unwrap_or_default());
            Place { left: corner.x, top: corner.y, width: size.width, height: size.height }
        });
        Args {
            technique: viewer.settings.technique,
            max_bounces: Some(viewer.settings.max_bounces),
            exposure: viewer.look.exposure,
            camera: Some(viewer.camera.now()),
            pixel: viewer.query.map(|query| query.pixel),
            sample: viewer.query.map_or(0, |query| query.sample),
            place,
            ..args.clone()
        }
    }
}

impl ApplicationHandler<Message> for Shell {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.screen.is_some() {
            return;
        }
        let (width, height) = self.content.viewer.size();
        let mut attributes = Window::default_attributes().with_title(self.scene_name());
        attributes = match self.content.args.place {
            None => {
                // Panels need some place, too.
                let scale = (LEGIBLE / width).max(1);
                attributes.with_inner_size(PhysicalSize::new(scale * width, scale * height))
            }
            Some(place) => attributes
                .with_inner_size(PhysicalSize::new(place.width, place.height))
                .with_position(PhysicalPosition::new(place.left, place.top)),
        };
        let screen = events.create_window(attributes).map_err(|error| error.to_string()).and_then(|window| {
            let window = Rc::new(window);
            let context = softbuffer::Context::new(Rc::clone(&window)).map_err(|error| error.to_string())?;
            let surface =
                softbuffer::Surface::new(&context, Rc::clone(&window)).map_err(|error| error.to_string())?;
            Ok(Screen { window, surface })
        });
        match screen {
            Ok(screen) => self.screen = Some(screen),
            Err(error) => {
                self.failure = Some(Failure::Broken(format!("cannot open a window: {error}")));
                events.exit();
            }
        }
        self.update();
    }

    fn user_event(&mut self, _: &ActiveEventLoop, message: Message) {
        match message {
            Message::Renderer(News::Frame) => {}
            Message::Renderer(News::Saved(saved)) => {
                let text =
                    saved.map_or_else(|why| format!("not saved: {why}"), |files| format!("saved {files}"));
                println!("{text}");
                self.content.viewer.message = Some(text);
            }
            Message::Renderer(News::Panicked) => {
                self.trouble = Some(format!("the algorithm panicked: {}", restart::first_panic()));
            }
            Message::Traced(traced) => self.content.viewer.take(*traced),
            Message::Reload(reload) => self.reload(reload),
        }
        self.show();
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => {
                // Not by way of `Drop`, which would wait for an algorithm that never ends.
                std::process::exit(0);
            }
            WindowEvent::RedrawRequested => self.paint(),
            WindowEvent::Resized(_) => self.show(),
            event if self.input(&event) => self.update(),
            _ => {}
        }
    }
}
