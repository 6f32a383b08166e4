//! A virtual display, and a program with a window in it.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// How long something may take that normally takes a moment.
const PATIENCE: Duration = Duration::from_secs(60);

/// How long a picture must stay to count as settled.
const SETTLED: Duration = Duration::from_millis(300);

/// A virtual display without a window manager. It ends when this is dropped.
pub(crate) struct Desktop {
    server: Child,
    display: String,
    folder: tempfile::TempDir,
}

impl Desktop {
    /// Starts a display; `None`, with a sentence, where Xvfb or xdotool is not installed.
    pub(crate) fn start() -> Option<Self> {
        let is_installed = |program: &str| {
            Command::new("which").arg(program).output().is_ok_and(|output| output.status.success())
        };
        if let Some(missing) = ["Xvfb", "xdotool"].into_iter().find(|program| !is_installed(program)) {
            println!("skipped: {missing} is not installed");
            return None;
        }
        let folder = tempfile::tempdir().expect("a folder");
        let mut command = Command::new("Xvfb");
        // By default it starts anew when its last client leaves, and refuses others meanwhile.
        command.args([
            "-noreset",
            "-displayfd",
            "1",
            "-screen",
            "0",
            "1024x768x24",
            "-nolisten",
            "tcp",
            "-fbdir",
        ]);
        command.arg(folder.path()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut server = command.spawn().expect("Xvfb starts");
        let mut number = String::new();
        let output = server.stdout.take().expect("it is piped");
        BufReader::new(output).read_line(&mut number).expect("Xvfb says its number");
        Some(Self { server, display: format!(":{}", number.trim()), folder })
    }

    /// Starts a program in a folder of its own, and waits for its window.
    pub(crate) fn open(&self, mut command: Command) -> Program<'_> {
        let folder = tempfile::tempdir().expect("a folder");
        command.current_dir(folder.path()).env("DISPLAY", &self.display).env_remove("WAYLAND_DISPLAY");
        let mut child = command.stdout(Stdio::piped()).spawn().expect("the program starts");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            output.lines().map_while(Result::ok).for_each(|line| drop(sender.send(line)));
        });
        let mut program = Program { desktop: self, child, lines, window: String::new(), folder };
        program.wait_for_window();
        program
    }

    fn xdotool(&self, arguments: &[&str]) -> String {
        let mut command = Command::new("xdotool");
        let output = command.args(arguments).env("DISPLAY", &self.display).output().expect("xdotool starts");
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// The colours in the upper left corner of the screen.
    fn shot(&self, (width, height): (usize, usize)) -> Shot {
        let mut bytes = Vec::new();
        let screen = File::open(self.folder.path().join("Xvfb_screen0"));
        screen.and_then(|mut file| file.read_to_end(&mut bytes)).expect("the screen can be read");
        // The format of xwd: numbers of four bytes, the largest first; then the palette; then rows of pixels.
        let number = |index: usize| {
            u32::from_be_bytes(bytes[4 * index..][..4].try_into().expect("four bytes")) as usize
        };
        let (header, row, palette) = (number(0), number(12), 12 * number(19));
        let pixel = |x: usize, y: usize| {
            let start = header + palette + y * row + 4 * x;
            u32::from_le_bytes(bytes[start..][..4].try_into().expect("four bytes")) & 0xff_ff_ff
        };
        let pixels =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Shot { width, pixels }
    }
}

impl Drop for Desktop {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A program with a window in the upper left corner of the screen.
pub(crate) struct Program<'a> {
    desktop: &'a Desktop,
    child: Child,
    lines: Receiver<String>,
    window: String,
    folder: tempfile::TempDir,
}

impl Program<'_> {
    /// The folder the program runs in.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Waits until the process was started with an argument that begins like this, and has a window.
    pub(crate) fn wait_for_restart(&mut self, beginning: &str) {
        let file = format!("/proc/{}/cmdline", self.child.id());
        until(beginning, || {
            let arguments = std::fs::read_to_string(&file).unwrap_or_default();
            arguments.split('\0').any(|argument| argument.starts_with(beginning)).then_some(())
        });
        self.wait_for_window();
    }

    /// Waits until the program has a window.
    fn wait_for_window(&mut self) {
        let id = self.child.id().to_string();
        self.window = until("a window", || {
            let ended = self.child.try_wait().expect("its status is known");
            assert_eq!(ended, None, "the program has ended");
            let found = self.desktop.xdotool(&["search", "--pid", &id]);
            found.lines().last().map(str::to_owned)
        });
        // Without a window manager nobody else gives it the focus.
        self.desktop.xdotool(&["windowfocus", "--sync", &self.window]);
    }

    /// Presses a key.
    pub(crate) fn key(&self, name: &str) {
        self.desktop.xdotool(&["key", name]);
    }

    /// Clicks on a place.
    pub(crate) fn click(&self, (x, y): (u32, u32)) {
        self.desktop.xdotool(&["mousemove", &x.to_string(), &y.to_string(), "click", "1"]);
    }

    /// Moves the mouse with its left button pressed.
    pub(crate) fn drag(&self, from: (u32, u32), to: (u32, u32)) {
        let [from_x, from_y, to_x, to_y] = [from.0, from.1, to.0, to.1].map(|number| number.to_string());
        self.desktop.xdotool(&["mousemove", &from_x, &from_y, "mousedown", "1"]);
        self.desktop.xdotool(&["mousemove", &to_x, &to_y, "mouseup", "1"]);
    }

    /// The colours of the window.
    pub(crate) fn shot(&self, size: (usize, usize)) -> Shot {
        self.desktop.shot(size)
    }

    /// The window once it has stopped changing: a title may be set a moment before its picture is shown.
    pub(crate) fn settled_shot(&self, size: (usize, usize)) -> Shot {
        let mut last = self.shot(size);
        until("a picture that stays", || {
            std::thread::sleep(SETTLED);
            let now = self.shot(size);
            let stays = now.differs_from(&last) == 0;
            last = now.clone();
            stays.then_some(now)
        })
    }

    /// Waits until the title contains a text.
    pub(crate) fn wait_for_title(&self, text: &str) {
        until(text, || self.desktop.xdotool(&["getwindowname", &self.window]).contains(text).then_some(()));
    }

    /// Waits until the window looks like this.
    pub(crate) fn wait_for(&self, what: &str, is_so: impl Fn(&Shot) -> bool, size: (usize, usize)) {
        until(what, || is_so(&self.shot(size)).then_some(()));
    }

    /// Waits until the window shows a picture.
    pub(crate) fn wait_for_shot(&self, size: (usize, usize), expected: &Shot, what: &str) {
        self.wait_for(what, |shot| shot.differs_from(expected) == 0, size);
    }

    /// Waits for a line of output that begins like this.
    pub(crate) fn wait_for_output(&mut self, beginning: &str) -> String {
        loop {
            let line = self.lines.recv_timeout(PATIENCE);
            let line = line.unwrap_or_else(|_| panic!("no line of output begins with `{beginning}`"));
            if line.starts_with(beginning) {
                return line;
            }
        }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Colours on the screen, `0x00RRGGBB`, row by row from the top.
#[derive(Clone)]
pub(crate) struct Shot {
    pub(crate) width: usize,
    pub(crate) pixels: Vec<u32>,
}

impl Shot {
    /// The colour of a pixel.
    pub(crate) fn at(&self, x: usize, y: usize) -> u32 {
        self.pixels[y * self.width + x]
    }

    /// Number of pixels of a colour.
    pub(crate) fn count(&self, color: u32) -> usize {
        self.pixels.iter().filter(|pixel| **pixel == color).count()
    }

    /// Number of pixels that differ.
    pub(crate) fn differs_from(&self, other: &Self) -> usize {
        assert_eq!(self.pixels.len(), other.pixels.len());
        self.pixels.iter().zip(&other.pixels).filter(|(a, b)| a != b).count()
    }

    /// Checks that all pixels are the same.
    pub(crate) fn assert_same(&self, other: &Self, what: &str) {
        assert_eq!(self.differs_from(other), 0, "{what}: this many pixels differ");
    }
}

/// Asks again until there is an answer.
fn until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        if let Some(answer) = ask() {
            return answer;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("waited in vain for: {what}");
}
