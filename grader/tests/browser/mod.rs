//! A browser that tests drive as a person would: with a mouse and a keyboard, through Chromium's DevTools protocol.
//!
//! The protocol goes through the browser's pipe (`--remote-debugging-pipe`: descriptors 3 and 4, messages that end in a
//! zero byte), which a shell connects with the child's standard input and output. So it takes no port and no crate.

pub(crate) mod axe;

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Names that the program goes by.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// How long a test waits for what a page should do.
const PATIENCE: Duration = Duration::from_secs(60);

/// A browser with one page.
pub(crate) struct Browser {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    session: Option<String>,
    number: u64,
    /// What the browser has told since the page was opened.
    pub(crate) events: Vec<Value>,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts one; `None`, and says so, if there is none on this machine.
    pub(crate) fn start() -> Option<Self> {
        let works = |name: &&&str| {
            let version =
                Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
            version.is_ok_and(|status| status.success())
        };
        let Some(name) = NAMES.iter().find(works) else {
            // Not by a macro, whose words are kept back of tests that pass.
            let words =
                format!("LEFT OUT: none of {} is installed, so that no page was opened\n", NAMES.join(", "));
            std::io::stderr().write_all(words.as_bytes()).expect("somebody listens");
            return None;
        };
        let profile = tempfile::tempdir().expect("a temporary folder");
        let command = format!(
            "exec {name} --headless --no-sandbox --disable-gpu --no-first-run --user-data-dir=\"$0\" \
             --remote-debugging-pipe 3<&0 4>&1 >/dev/null 2>&1"
        );
        let mut child = Command::new("sh")
            .args(["-c", &command])
            .arg(profile.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let input = child.stdin.take().expect("it is piped");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let (session, number, events) = (None, 0, Vec::new());
        let mut browser = Self { child, input, output, session, number, events, _profile: profile };
        let target = browser.call("Target.createTarget", json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        let session = browser.call("Target.attachToTarget", attach)["sessionId"].clone();
        browser.session = session.as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }

    /// Asks the browser for something, and gives its answer.
    pub(crate) fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.number += 1;
        let mut message = json!({"id": self.number, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.input.write_all(format!("{message}\0").as_bytes()).expect("the browser listens");
        self.input.flush().expect("the browser listens");
        loop {
            let mut bytes = Vec::new();
            self.output.read_until(0, &mut bytes).expect("the browser answers");
            bytes.pop();
            let answer: Value = serde_json::from_slice(&bytes).expect("the browser speaks JSON");
            if answer["id"] == self.number {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.events.push(answer);
        }
    }

    /// Opens a file in a window of this size, and waits until it is there.
    pub(crate) fn open(&mut self, file: &Path, width: u32, height: u32) {
        let size = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", size);
        self.events.clear();
        let url = format!("file://{}", file.display());
        self.call("Page.navigate", json!({"url": url}));
        self.wait("document.readyState === 'complete' && location.protocol === 'file:'");
    }

    /// What a script gives, as JSON.
    pub(crate) fn ask(&mut self, script: &str) -> Value {
        let answer = self.call("Runtime.evaluate", json!({"expression": script, "returnByValue": true}));
        assert!(answer["exceptionDetails"].is_null(), "{script}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].clone()
    }

    /// What a script gives, as text.
    pub(crate) fn text(&mut self, script: &str) -> String {
        self.ask(script).as_str().unwrap_or_default().to_owned()
    }

    /// Waits until a condition holds.
    pub(crate) fn wait(&mut self, condition: &str) {
        let start = Instant::now();
        while self.ask(condition) != json!(true) {
            assert!(start.elapsed() < PATIENCE, "it never came to be: {condition}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The place on the screen, in pixels, at these shares of an element's width and height; it is scrolled into sight.
    pub(crate) fn place(&mut self, element: &str, (x, y): (f64, f64)) -> (f64, f64) {
        let script = format!(
            "(() => {{ const it = {element}; it.scrollIntoView({{block: 'center'}}); const box = it.getBoundingClientRect(); \
             return [box.left + {x} * box.width, box.top + {y} * box.height]; }})()"
        );
        let place = self.ask(&script);
        (place[0].as_f64().expect("a number"), place[1].as_f64().expect("a number"))
    }

    /// Moves the mouse over an element.
    pub(crate) fn point(&mut self, element: &str, share: (f64, f64)) {
        let (x, y) = self.place(element, share);
        self.call("Input.dispatchMouseEvent", json!({"type": "mouseMoved", "x": x, "y": y}));
    }

    /// Clicks on an element.
    pub(crate) fn click(&mut self, element: &str, share: (f64, f64)) {
        self.point(element, share);
        let (x, y) = self.place(element, share);
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1});
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Turns the wheel over an element, with Ctrl held down; below 0 is away from oneself.
    pub(crate) fn turn_wheel(&mut self, element: &str, share: (f64, f64), by: f64) {
        let (x, y) = self.place(element, share);
        let event = json!({"type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by, "modifiers": 2});
        self.call("Input.dispatchMouseEvent", event);
    }

    /// Presses a key: a letter or other character, or the name of one as in `ArrowLeft`.
    pub(crate) fn press(&mut self, key: &str) {
        let code = match key {
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            "Home" => 36,
            "End" => 35,
            "Enter" => 13,
            "Tab" => 9,
            _ => 0,
        };
        let mut event = json!({"type": "keyDown", "key": key, "windowsVirtualKeyCode": code});
        if key == "Enter" {
            event["text"] = json!("\r");
        } else if key.chars().count() == 1 {
            event["text"] = json!(key);
        }
        self.call("Input.dispatchKeyEvent", event);
        let event = json!({"type": "keyUp", "key": key, "windowsVirtualKeyCode": code});
        self.call("Input.dispatchKeyEvent", event);
    }

    /// Gives an element the focus.
    pub(crate) fn focus(&mut self, element: &str) {
        self.ask(&format!("{element}.focus()"));
    }

    /// Saves what the page looks like, all of it, as PNG.
    pub(crate) fn screenshot(&mut self, file: &Path) {
        let answer = self.call("Page.captureScreenshot", json!({"captureBeyondViewport": true}));
        let text = answer["data"].as_str().expect("a picture");
        use base64::Engine;
        let bytes = base64::engine::general_purpose::STANDARD.decode(text).expect("Base64");
        std::fs::write(file, bytes).expect("it can be written");
    }

    /// Everything that went wrong since the page was opened: errors of scripts, what the policy has refused, and
    /// whatever was asked for that is not a file or part of the page.
    pub(crate) fn complaints(&mut self) -> Vec<String> {
        // Whatever is on its way arrives before the answer.
        self.ask("1");
        let complaint = |event: &Value| match event["method"].as_str()? {
            "Runtime.exceptionThrown" => Some(event["params"]["exceptionDetails"].to_string()),
            // Warnings are advice, as on how to read a canvas fast.
            "Log.entryAdded" => {
                let entry = &event["params"]["entry"];
                (entry["level"] == "error").then(|| entry.to_string())
            }
            "Network.requestWillBeSent" => {
                let url = event["params"]["request"]["url"].as_str()?;
                let own = url.starts_with("file:") || url.starts_with("data:");
                (!own).then(|| format!("asked for {url}"))
            }
            _ => None,
        };
        self.events.iter().filter_map(complaint).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
