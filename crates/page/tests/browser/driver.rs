//! A browser that obeys by way of chromedriver (WebDriver, W3C).

use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::http;

/// A browser may take this long to start on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// What Chromium is started with: no display, no sandbox (tests may run as root), and nothing on its own.
const ARGUMENTS: [&str; 9] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--force-device-scale-factor=1",
];

pub(crate) struct Driver {
    process: Child,
    port: u16,
    session: String,
}

impl Driver {
    /// Starts a browser with a window of this size.
    pub(crate) fn start((width, height): (u32, u32)) -> Self {
        let port = free_port();
        let process = Command::new("chromedriver")
            .arg(format!("--port={port}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("chromedriver");
        let mut driver = Self { process, port, session: String::new() };
        driver.wait_for_it();
        let mut arguments = ARGUMENTS.map(str::to_owned).to_vec();
        arguments.push(format!("--window-size={width},{height}"));
        let options = json!({ "args": arguments });
        let wanted =
            json!({ "capabilities": { "alwaysMatch": { "goog:chromeOptions": options } } });
        let session = driver.ask("POST", "/session", &wanted);
        driver.session = session["sessionId"].as_str().expect("a session").to_owned();
        driver
    }

    fn wait_for_it(&self) {
        let begin = Instant::now();
        while TcpStream::connect(("127.0.0.1", self.port)).is_err() {
            assert!(begin.elapsed() < PATIENCE, "chromedriver never listens");
            sleep(Duration::from_millis(20));
        }
    }

    fn ask(&self, method: &str, path: &str, body: &Value) -> Value {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("chromedriver");
        let start = format!("{method} {path} HTTP/1.1");
        let body = body.to_string();
        http::write(&stream, &start, "application/json", body.as_bytes()).expect("told");
        let answer = http::read(&stream).expect("an answer");
        let mut value: Value = serde_json::from_slice(&answer.body).expect("JSON");
        assert!(answer.start.contains(" 200 "), "{path}: {value}");
        value["value"].take()
    }

    fn tell(&self, path: &str, body: &Value) -> Value {
        self.ask("POST", &format!("/session/{}{path}", self.session), body)
    }

    pub(crate) fn go_to(&self, url: &str) {
        self.tell("/url", &json!({ "url": url }));
    }

    /// What a script returns.
    pub(crate) fn run(&self, script: &str, arguments: &[&str]) -> Value {
        self.tell("/execute/sync", &json!({ "script": script, "args": arguments }))
    }

    /// Types into an element; into an input of files their paths.
    pub(crate) fn type_into(&self, selector: &str, text: &str) {
        let found = json!({ "using": "css selector", "value": selector });
        let element = self.tell("/element", &found);
        let id = element.as_object().and_then(|of| of.values().next()).and_then(Value::as_str);
        let path = format!("/element/{}/value", id.expect("an element"));
        self.tell(&path, &json!({ "text": text }));
    }

    /// Presses the mouse at the first of these points of the window, moves it to the others, and lets go.
    pub(crate) fn press_along(&self, points: &[(f64, f64)]) {
        let to = |(x, y): (f64, f64)| {
            json!({
                "type": "pointerMove", "duration": 30, "x": x.round() as i64, "y": y.round() as i64
            })
        };
        let button = |kind: &str| json!({ "type": kind, "button": 0 });
        let mut actions = vec![to(points[0]), button("pointerDown")];
        actions.extend(points[1..].iter().copied().map(to));
        actions.push(button("pointerUp"));
        let mouse = json!({ "type": "pointer", "id": "mouse", "actions": actions });
        self.tell("/actions", &json!({ "actions": [mouse] }));
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        if !self.session.is_empty() && !std::thread::panicking() {
            self.ask("DELETE", &format!("/session/{}", self.session), &json!({}));
        }
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A port that nobody listens on.
fn free_port() -> u16 {
    let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    listener.local_addr().expect("bound").port()
}
