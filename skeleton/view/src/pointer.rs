//! From buttons and motions of the mouse to gestures. All places are in pixels of the picture.

/// What the mouse asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// Move the camera around the centre, after the mouse has moved right and down.
    Orbit(f32, f32),
    /// Shift the picture right and down.
    Pan(f32, f32),
    /// Move the camera towards the centre.
    Zoom(f32),
    /// Move the divider of a wipe to this column.
    Divider(f32),
    /// A click on this place.
    Click(f32, f32),
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The left button.
    Left,
    /// Any other button.
    Other,
}

/// Distance from which on a motion with a pressed button is not a click.
const CLICK: f32 = 3.0;
/// Distance from the divider of a wipe within which it is grabbed.
const GRAB: f32 = 6.0;

/// What the mouse is doing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pointer {
    at: (f32, f32),
    pressed: Option<Pressed>,
}

#[derive(Clone, Copy, Debug)]
struct Pressed {
    from: (f32, f32),
    drag: Drag,
    /// True from the first motion on that is not part of a click.
    moved: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drag {
    Orbit,
    Pan,
    Divider,
}

impl Pointer {
    /// A button was pressed. `shift` tells whether the shift key is, `divider` is its column if there is a wipe.
    pub fn press(&mut self, button: Button, shift: bool, divider: Option<f32>) {
        let drag = match button {
            Button::Left if divider.is_some_and(|column| (column - self.at.0).abs() <= GRAB) => Drag::Divider,
            Button::Left if !shift => Drag::Orbit,
            _ => Drag::Pan,
        };
        self.pressed = Some(Pressed { from: self.at, drag, moved: false });
    }

    /// The mouse has moved to a place.
    pub fn move_to(&mut self, at: (f32, f32)) -> Option<Gesture> {
        let last = std::mem::replace(&mut self.at, at);
        let pressed = self.pressed.as_mut()?;
        let was_moved = pressed.moved;
        pressed.moved |= (at.0 - pressed.from.0).hypot(at.1 - pressed.from.1) > CLICK;
        if !pressed.moved {
            return None;
        }
        let last = if was_moved { last } else { pressed.from };
        let by = (at.0 - last.0, at.1 - last.1);
        Some(match pressed.drag {
            Drag::Orbit => Gesture::Orbit(by.0, by.1),
            Drag::Pan => Gesture::Pan(by.0, by.1),
            Drag::Divider => Gesture::Divider(at.0),
        })
    }

    /// The button was released.
    pub fn release(&mut self) -> Option<Gesture> {
        let pressed = self.pressed.take()?;
        let is_click = !pressed.moved && pressed.drag == Drag::Orbit;
        is_click.then_some(Gesture::Click(self.at.0, self.at.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f32, y: f32) -> Pointer {
        Pointer { at: (x, y), pressed: None }
    }

    #[test]
    fn a_short_motion_is_a_click_and_a_longer_one_a_drag_with_its_whole_length() {
        let mut click = at(10.0, 20.0);
        click.press(Button::Left, false, None);
        assert_eq!(click.move_to((12.0, 20.0)), None);
        assert_eq!(click.release(), Some(Gesture::Click(12.0, 20.0)));
        let mut drag = at(10.0, 20.0);
        drag.press(Button::Left, false, None);
        assert_eq!(drag.move_to((12.0, 20.0)), None);
        assert_eq!(drag.move_to((10.0, 26.0)), Some(Gesture::Orbit(0.0, 6.0)));
        assert_eq!(drag.move_to((11.0, 26.0)), Some(Gesture::Orbit(1.0, 0.0)));
        assert_eq!(drag.release(), None);
        assert_eq!(drag.move_to((50.0, 50.0)), None, "no button is pressed");
    }

    #[test]
    fn shift_and_other_buttons_pan() {
        for (button, shift) in [(Button::Left, true), (Button::Other, false)] {
            let mut pointer = at(0.0, 0.0);
            pointer.press(button, shift, None);
            assert_eq!(pointer.move_to((9.0, 0.0)), Some(Gesture::Pan(9.0, 0.0)));
            assert_eq!(pointer.release(), None);
        }
    }

    #[test]
    fn the_divider_is_grabbed_nearby_only() {
        let mut near = at(103.0, 5.0);
        near.press(Button::Left, false, Some(100.0));
        assert_eq!(near.move_to((140.0, 5.0)), Some(Gesture::Divider(140.0)));
        let mut far = at(120.0, 5.0);
        far.press(Button::Left, false, Some(100.0));
        assert_eq!(far.move_to((130.0, 5.0)), Some(Gesture::Orbit(10.0, 0.0)));
    }
}
