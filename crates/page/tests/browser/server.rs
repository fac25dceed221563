//! A web server of one folder, which notes what it is asked for.

use std::fs;
use std::io;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;

use crate::http;

pub(crate) struct Server {
    pub(crate) port: u16,
    requests: Arc<Mutex<Vec<String>>>,
}

impl Server {
    /// Serves until the program ends.
    pub(crate) fn of(folder: PathBuf) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
        let port = listener.local_addr().expect("bound").port();
        let requests = Arc::new(Mutex::new(Vec::new()));
        let noted = requests.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                // A browser that hangs up misses nothing.
                let _ = answer(&stream, &folder, &noted);
            }
        });
        Self { port, requests }
    }

    /// The first line of each request.
    pub(crate) fn requests(&self) -> Vec<String> {
        self.requests.lock().expect("no panic").clone()
    }
}

fn answer(stream: &TcpStream, folder: &Path, noted: &Mutex<Vec<String>>) -> io::Result<()> {
    let request = http::read(stream)?;
    noted.lock().expect("no panic").push(request.start.clone());
    let path = request.start.split(' ').nth(1).unwrap_or_default().trim_start_matches('/');
    let path = if path.is_empty() { "index.html" } else { path };
    let kind = match Path::new(path).extension().and_then(|ending| ending.to_str()) {
        Some("html") => "text/html",
        Some("js") => "text/javascript",
        Some("css") => "text/css",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    };
    match fs::read(folder.join(path)) {
        Ok(bytes) => http::write(stream, "HTTP/1.1 200 OK", kind, &bytes),
        Err(_) => http::write(stream, "HTTP/1.1 404 Not Found", "text/plain", b""),
    }
}
