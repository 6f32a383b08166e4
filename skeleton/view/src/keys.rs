//! What keys do.

use arty::cli::DebugView;
use arty::integrator::Technique;

/// A key of the keyboard, as far as the window knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// The home key.
    Home,
    /// The escape key.
    Escape,
    /// A key that writes a character.
    Character(char),
}

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Move the camera around the centre: right and up, in degrees.
    Orbit(f32, f32),
    /// Move camera and centre: right, up and forward, in distances between them.
    Walk(f32, f32, f32),
    /// Move the camera back to the scene's.
    Home,
    /// Use the next technique.
    NextTechnique,
    /// Use this technique.
    Technique(Technique),
    /// Allow one bounce less or more.
    Bounces(i32),
    /// Change the exposure, in stops.
    Exposure(f32),
    /// Set the exposure to 0.
    NoExposure,
    /// Use the next tone map.
    ToneMap,
    /// Show a property of surfaces, or radiance again.
    Show(DebugView),
    /// Save the picture.
    Save,
    /// Stop refining, or go on.
    Pause,
    /// Show or hide the keys.
    Help,
    /// Print the camera for a scene file.
    PrintCamera,
    /// Compare with another technique, then with the reference, then with nothing.
    Wipe,
    /// Use the next technique for the right part of a wipe.
    NextRight,
    /// Equal samples or equal time for a wipe.
    Balance,
    /// Show the path of another sample: this much further.
    Step(i64),
    /// Show the path of the brightest sample.
    Brightest,
    /// Hide or show the numbers of a path.
    Numbers,
    /// Close what is open: paths, keys, wipe.
    Close,
}

/// Degrees per press of an arrow key.
const ORBIT: f32 = 5.0;
/// Distances between camera and centre per step.
const WALK: f32 = 0.05;
/// Stops per press.
const STOPS: f32 = 0.5;

/// The action of a key.
pub fn action(key: Key) -> Option<Action> {
    Some(match key {
        Key::Left => Action::Orbit(-ORBIT, 0.0),
        Key::Right => Action::Orbit(ORBIT, 0.0),
        Key::Up => Action::Orbit(0.0, ORBIT),
        Key::Down => Action::Orbit(0.0, -ORBIT),
        Key::Home => Action::Home,
        Key::Escape => Action::Close,
        // The only letter whose case matters.
        Key::Character('S') => Action::Save,
        Key::Character(character) => match character.to_ascii_lowercase() {
            'w' => Action::Walk(0.0, 0.0, WALK),
            's' => Action::Walk(0.0, 0.0, -WALK),
            'a' => Action::Walk(-WALK, 0.0, 0.0),
            'd' => Action::Walk(WALK, 0.0, 0.0),
            'q' => Action::Walk(0.0, -WALK, 0.0),
            'e' => Action::Walk(0.0, WALK, 0.0),
            'r' => Action::NextTechnique,
            '1' => Action::Technique(Technique::Bsdf),
            '2' => Action::Technique(Technique::Nee),
            '3' => Action::Technique(Technique::Mis),
            '[' => Action::Bounces(-1),
            ']' => Action::Bounces(1),
            '-' => Action::Exposure(-STOPS),
            '+' | '=' => Action::Exposure(STOPS),
            '0' => Action::NoExposure,
            't' => Action::ToneMap,
            'n' => Action::Show(DebugView::Normals),
            'l' => Action::Show(DebugView::Albedo),
            ' ' => Action::Pause,
            '?' | 'h' => Action::Help,
            'p' => Action::PrintCamera,
            'v' => Action::Wipe,
            'c' => Action::NextRight,
            'g' => Action::Balance,
            ',' => Action::Step(-1),
            '.' => Action::Step(1),
            'b' => Action::Brightest,
            'i' => Action::Numbers,
            _ => return None,
        },
    })
}

/// Keys and what they do, for the window itself.
pub const HELP: [(&str, &str); 21] = [
    ("arrows, left button", "orbit"),
    ("w a s d  q e", "walk, down and up"),
    ("Shift or right button", "pan"),
    ("wheel", "zoom"),
    ("Home", "the scene's camera"),
    ("p", "print the camera as YAML"),
    ("r  1 2 3", "technique: next, bsdf, nee, mis"),
    ("[ ]", "maximum number of bounces"),
    ("- + 0", "exposure"),
    ("t", "tone map"),
    ("n l", "normals, albedo"),
    ("Space", "pause"),
    ("Shift+S", "save PNG and EXR"),
    ("v", "wipe: technique, reference, off"),
    ("c", "wipe: next technique at the right"),
    ("g", "wipe: equal samples, equal time"),
    ("click", "show the paths of a pixel"),
    (", .", "path of the sample before, after"),
    ("b", "path of the brightest sample"),
    ("i", "hide or show the numbers of a path"),
    ("Esc", "close paths, keys, wipe"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_in_the_help_is_a_key() {
        for (keys, _) in HELP {
            for key in keys.split(' ').filter(|key| key.chars().count() == 1) {
                let key = key.chars().next().expect("one character");
                assert!(action(Key::Character(key)).is_some(), "{key}");
            }
        }
    }

    #[test]
    fn s_walks_back_and_with_shift_it_saves() {
        assert_eq!(action(Key::Character('s')), Some(Action::Walk(0.0, 0.0, -WALK)));
        assert_eq!(action(Key::Character('S')), Some(Action::Save));
        assert_eq!(
            action(Key::Character('R')),
            action(Key::Character('r')),
            "caps lock changes nothing else"
        );
        assert_eq!(action(Key::Character('ß')), None);
    }
}
