//! A browser at work: a small client of WebDriver (<https://www.w3.org/TR/webdriver2/>) for Chromium's driver.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A browser without a screen, and its driver; both end with it.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
    _profile: crate::scratch::Folder,
}

impl Browser {
    /// A new browser.
    ///
    /// # Panics
    /// If it does not start.
    pub fn new((browser, driver): &(std::path::PathBuf, std::path::PathBuf)) -> Self {
        let profile = crate::scratch::folder();
        let mut driver =
            Command::new(driver).args(["--port=0"]).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut lines = BufReader::new(driver.stdout.take().unwrap()).lines().map_while(Result::ok);
        // The first line that names one names the 0 that was asked for.
        let port =
            |line: String| line.split("on port ").nth(1)?.trim_end_matches('.').parse().ok().filter(|port| *port > 0);
        let port = lines.find_map(port).unwrap();
        std::thread::spawn(move || lines.for_each(drop));
        let mut it = Browser { driver, port, session: String::new(), _profile: profile };
        let profile = format!("--user-data-dir={}", it._profile.path().display());
        let flags = [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--window-size=1100,900",
            &profile,
        ];
        let options = json!({ "binary": browser, "args": flags });
        let wanted = json!({ "browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": { "browser": "ALL" } });
        let made = it.call("POST", "/session", &json!({ "capabilities": { "alwaysMatch": wanted } }));
        it.session = made["sessionId"].as_str().unwrap_or_else(|| panic!("{made}")).to_string();
        it
    }

    fn call(&self, verb: &str, path: &str, body: &Value) -> Value {
        let body = if verb == "POST" { body.to_string() } else { String::new() };
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let head = format!(
            "{verb} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
            self.port,
            body.len()
        );
        stream.write_all((head + &body).as_bytes()).unwrap();
        let mut reader = BufReader::new(stream);
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line).unwrap();
            let line = line.trim().to_ascii_lowercase();
            if let Some(n) = line.strip_prefix("content-length:") {
                length = n.trim().parse().unwrap();
            }
            if line.is_empty() {
                break;
            }
        }
        let mut content = vec![0; length];
        reader.read_exact(&mut content).unwrap();
        let answer: Value = serde_json::from_slice(&content).unwrap();
        answer["value"].clone()
    }

    fn post(&self, path: &str, body: Value) -> Value {
        let answer = self.call("POST", &format!("/session/{}/{path}", self.session), &body);
        assert!(answer["error"].is_null(), "{path}: {answer}");
        answer
    }

    /// Opens a file and waits until its script has done its work.
    ///
    /// # Panics
    /// If it does not in a minute, or says that it has failed.
    pub fn open(&self, file: &Path) {
        self.post("url", json!({ "url": format!("file://{}", file.display()) }));
        let began = Instant::now();
        while self.run("return document.documentElement.dataset.drawn ?? null").is_null() {
            let failed = self.run("return document.documentElement.dataset.failed ?? null");
            assert!(failed.is_null() && began.elapsed() < Duration::from_secs(60), "{failed}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// What a script returns.
    pub fn run(&self, script: &str) -> Value {
        self.post("execute/sync", json!({ "script": script, "args": [] }))
    }

    /// A command of the browser's own protocol.
    pub fn command(&self, name: &str, given: Value) -> Value {
        self.post("goog/cdp/execute", json!({ "cmd": name, "params": given }))
    }

    /// Clicks a point of the window.
    pub fn click(&self, x: f64, y: f64) {
        let actions = json!([
            { "type": "pointerMove", "duration": 0, "x": x.round() as i64, "y": y.round() as i64, "origin": "viewport" },
            { "type": "pause", "duration": 100 },
            { "type": "pointerDown", "button": 0 },
            { "type": "pause", "duration": 50 },
            { "type": "pointerUp", "button": 0 },
        ]);
        self.post("actions", json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": actions }] }));
    }

    /// Types keys at what has the focus.
    pub fn keys(&self, keys: &str) {
        let press = |key: char| [json!({ "type": "keyDown", "value": key }), json!({ "type": "keyUp", "value": key })];
        let actions: Vec<Value> = keys.chars().flat_map(press).collect();
        self.post("actions", json!({ "actions": [{ "type": "key", "id": "keys", "actions": actions }] }));
    }

    /// Messages on the console since the last time.
    pub fn messages(&self) -> Vec<Value> {
        self.post("se/log", json!({ "type": "browser" })).as_array().cloned().unwrap_or_default()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() && !std::thread::panicking() {
            self.call("DELETE", &format!("/session/{}", self.session), &Value::Null);
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
