//! From events of the window to those of the viewer.

use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::keyboard::{Key as WindowKey, NamedKey};

use super::Shell;
use crate::fit::Fit;
use crate::keys::Key;
use crate::pointer::{Button, Gesture};

/// Pixels of a touchpad that count as one step of a wheel.
const PIXELS_PER_STEP: f64 = 40.0;

impl Shell {
    /// Takes an event. True if it may have changed the state.
    pub(super) fn input(&mut self, event: &WindowEvent) -> bool {
        match event {
            WindowEvent::ModifiersChanged(modifiers) => {
                self.shift = modifiers.state().shift_key();
                false
            }
            WindowEvent::KeyboardInput { event, .. } => {
                let key = key(&event.logical_key).filter(|_| event.state == ElementState::Pressed);
                if let Some(key) = key
                    && let Some(effect) = self.content.viewer.key(key)
                {
                    self.follow(effect);
                }
                key.is_some()
            }
            WindowEvent::CursorMoved { position, .. } => {
                let Some(screen) = &self.screen else { return false };
                let size = screen.window.inner_size();
                let fit = Fit::new(self.content.viewer.size(), (size.width, size.height));
                let at = fit.to_picture((position.x as f32, position.y as f32));
                let gesture = self.content.viewer.pointer().0.move_to(at);
                self.gesture(gesture)
            }
            WindowEvent::MouseInput { state: ElementState::Pressed, button, .. } => {
                let button = if *button == MouseButton::Left { Button::Left } else { Button::Other };
                let shift = self.shift;
                let (pointer, divider) = self.content.viewer.pointer();
                pointer.press(button, shift, divider);
                false
            }
            WindowEvent::MouseInput { state: ElementState::Released, .. } => {
                let gesture = self.content.viewer.pointer().0.release();
                self.gesture(gesture)
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => *lines,
                    MouseScrollDelta::PixelDelta(by) => (by.y / PIXELS_PER_STEP) as f32,
                };
                self.gesture(Some(Gesture::Zoom(steps)))
            }
            _ => false,
        }
    }

    fn gesture(&mut self, gesture: Option<Gesture>) -> bool {
        gesture.into_iter().for_each(|gesture| self.content.viewer.mouse(gesture));
        gesture.is_some()
    }
}

fn key(key: &WindowKey) -> Option<Key> {
    Some(match key {
        WindowKey::Named(NamedKey::ArrowLeft) => Key::Left,
        WindowKey::Named(NamedKey::ArrowRight) => Key::Right,
        WindowKey::Named(NamedKey::ArrowUp) => Key::Up,
        WindowKey::Named(NamedKey::ArrowDown) => Key::Down,
        WindowKey::Named(NamedKey::Home) => Key::Home,
        WindowKey::Named(NamedKey::Escape) => Key::Escape,
        WindowKey::Named(NamedKey::Space) => Key::Character(' '),
        WindowKey::Character(text) => Key::Character(text.chars().next()?),
        _ => return None,
    })
}
