//! The page, and what is done on it.

use std::env;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use metaball::Viewpoint;

use crate::driver::Driver;
use crate::server::Server;

/// A picture may take this long on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(120);

/// Pixels across and down of the browser's window.
const WINDOW: (u32, u32) = (960, 600);

pub(crate) struct Stage {
    driver: Driver,
    server: Server,
}

/// A picture that was taken off the canvas.
pub(crate) struct Taken {
    /// Pixels across and down.
    pub(crate) size: (u32, u32),
    /// Red, green, blue and opacity of each.
    pub(crate) rgba: Vec<u8>,
    /// Where it is seen from, as the page's command line says.
    pub(crate) viewpoint: Viewpoint,
}

const TAKE: &str = "
    const canvas = document.querySelector('#picture');
    const { width, height } = canvas;
    const { data } = canvas.getContext('2d').getImageData(0, 0, width, height);
    let text = '';
    for (let at = 0; at < data.length; at += 8192) {
        text += String.fromCharCode(...data.subarray(at, at + 8192));
    }
    return [width, height, btoa(text), document.querySelector('#command').value];";

impl Stage {
    /// The page of the folder `PAGE_FOLDER`, in a new browser.
    pub(crate) fn open() -> Self {
        let folder = PathBuf::from(env::var_os("PAGE_FOLDER").expect("PAGE_FOLDER: a folder"));
        assert!(folder.join("index.html").exists(), "PAGE_FOLDER: {}: no page", folder.display());
        let (server, driver) = (Server::of(folder), Driver::start(WINDOW));
        driver.go_to(&format!("http://127.0.0.1:{}/", server.port));
        Self { driver, server }
    }

    pub(crate) fn run(&self, script: &str) {
        self.driver.run(script, &[]);
    }

    /// Waits until an expression is true.
    pub(crate) fn until(&self, what: &str, expression: &str) {
        let begin = Instant::now();
        while self.driver.run(&format!("return Boolean({expression})"), &[]) != true {
            if begin.elapsed() > PATIENCE {
                let said = self.driver.run("return document.body.innerText", &[]);
                panic!("{what}: never; the page says {said}");
            }
            sleep(Duration::from_millis(50));
        }
    }

    /// The picture of a file when it has come as far as `stage`.
    pub(crate) fn rested(&self, file: &str, stage: &str) -> Taken {
        self.rested_at(file, stage, "certain")
    }

    /// The same, when the status line says so too.
    pub(crate) fn rested_at(&self, file: &str, stage: &str, status: &str) -> Taken {
        // After the last act the camera counts as moving for a while.
        sleep(Duration::from_millis(300));
        let text = |id: &str| format!("document.querySelector('#{id}').textContent");
        let expression = format!(
            "{} === '{file}' && document.querySelector('#picture').dataset.stage === '{stage}' && \
             {}.includes('{status}') && {} === ''",
            text("name"),
            text("status"),
            text("notice")
        );
        self.until(&format!("{file}, {stage}"), &expression);
        let taken = self.driver.run(TAKE, &[]);
        let length = |index: usize| taken[index].as_u64().expect("a length") as u32;
        Taken {
            size: (length(0), length(1)),
            rgba: STANDARD.decode(taken[2].as_str().expect("text")).expect("base64"),
            viewpoint: viewpoint(taken[3].as_str().expect("a command line")),
        }
    }

    /// Drags across the picture; places are from its top left, each from 0 to 1.
    pub(crate) fn drag(&self, from: (f64, f64), to: (f64, f64)) {
        self.driver.press_along(&[self.point(from), self.point(to)]);
    }

    pub(crate) fn click(&self, place: (f64, f64)) {
        self.driver.press_along(&[self.point(place)]);
    }

    fn point(&self, (right, down): (f64, f64)) -> (f64, f64) {
        let size = self.driver.run(
            "const { clientWidth, clientHeight } = document.querySelector('#picture');
            return [clientWidth, clientHeight];",
            &[],
        );
        let length = |index: usize| size[index].as_f64().expect("a length");
        (right * length(0), down * length(1))
    }

    /// Chooses a file of this machine.
    pub(crate) fn give(&self, path: &str) {
        let path = Path::new(path).canonicalize().expect("a file");
        self.driver.type_into("#file", path.to_str().expect("a path of Unicode"));
    }

    /// Drops a file onto the page.
    pub(crate) fn drop(&self, name: &str, text: &str) {
        self.driver.run(
            "const dataTransfer = new DataTransfer();
            dataTransfer.items.add(new File([arguments[1]], arguments[0]));
            document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true }));",
            &[name, text],
        );
    }

    /// The first line of each request that the page made.
    pub(crate) fn requests(&self) -> Vec<String> {
        self.server.requests()
    }
}

/// The flags of a camera in a command line.
fn viewpoint(command: &str) -> Viewpoint {
    let flag = |name: &str| {
        let start = format!("--{name}=");
        command.split(' ').find_map(|word| word.strip_prefix(&start))
    };
    let numbers = |text: &str| {
        let numbers: Vec<f64> =
            text.split(',').map(|number| number.parse().expect("a number")).collect();
        DVec3::from_slice(&numbers)
    };
    Viewpoint {
        eye: flag("eye").map(numbers),
        look_at: flag("look-at").map(numbers),
        up: flag("up").map(|text| numbers(text).as_vec3()),
        fov: flag("fov").map(|text| text.parse().expect("a number")),
    }
}
