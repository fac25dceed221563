//! Xvfb, a window of the binary on it, and synthetic events.

use std::error::Error;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _,
    EventMask, ImageFormat, MOTION_NOTIFY_EVENT, MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use crate::screen::Screen;

/// Pixels of the display.
pub(crate) const SIZE: (u16, u16) = (1280, 800);

/// A machine that is busy may take this long for anything.
const PATIENCE: Duration = Duration::from_secs(60);

pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// Whether there is an Xvfb.
pub(crate) fn is_there() -> bool {
    Command::new("Xvfb").arg("-help").output().is_ok_and(|output| output.status.success())
}

/// A process that ends with its owner.
struct Owned(Child);

impl Drop for Owned {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The binary with a window, on a display of its own.
pub(crate) struct Viewed {
    connection: RustConnection,
    root: Window,
    process: Owned,
    _display: Owned,
}

impl Viewed {
    /// Runs `metaball view` with these arguments.
    pub(crate) fn run(arguments: &[&str]) -> Outcome<Self> {
        let mut display = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0"])
            .arg(format!("{}x{}x24", SIZE.0, SIZE.1))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map(Owned)?;
        let output = display.0.stdout.take().ok_or("a pipe")?;
        let mut number = String::new();
        BufReader::new(output).read_line(&mut number)?;
        let name = format!(":{}", number.trim());
        let (connection, screen) = RustConnection::connect(Some(&name))?;
        let root = connection.setup().roots[screen].root;
        let process = Command::new(env!("CARGO_BIN_EXE_metaball"))
            .arg("view")
            .args(arguments)
            .env("DISPLAY", &name)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map(Owned)?;
        Ok(Self { connection, root, process, _display: display })
    }

    /// The window, when it is shown.
    pub(crate) fn window(&mut self) -> Outcome<Window> {
        self.until(|viewed| {
            for window in viewed.connection.query_tree(viewed.root)?.reply()?.children {
                let is_shown = viewed.connection.get_window_attributes(window)?.reply()?.map_state
                    == MapState::VIEWABLE;
                let size = viewed.connection.get_geometry(window)?.reply()?;
                if is_shown && size.width > 100 {
                    return Ok(Some(window));
                }
            }
            Ok(None)
        })
    }

    /// Asks again and again, until there is an answer.
    pub(crate) fn until<T>(&mut self, ask: impl Fn(&Self) -> Outcome<Option<T>>) -> Outcome<T> {
        let begin = Instant::now();
        loop {
            if let Some(answer) = ask(self)? {
                return Ok(answer);
            }
            if let Some(status) = self.process.0.try_wait()? {
                let error = self.process.0.stderr.take().ok_or("a pipe")?;
                return Err(format!("{status}: {}", std::io::read_to_string(error)?).into());
            }
            if begin.elapsed() > PATIENCE {
                return Err("it never came".into());
            }
            sleep(Duration::from_millis(20));
        }
    }

    /// What the display shows.
    pub(crate) fn screen(&self) -> Outcome<Screen> {
        let (width, height) = SIZE;
        let format = ImageFormat::Z_PIXMAP;
        let image = self.connection.get_image(format, self.root, 0, 0, width, height, !0)?;
        Ok(Screen::new(usize::from(width), &image.reply()?.data))
    }

    /// Presses the first button at a place, moves the pointer, and lets go.
    pub(crate) fn drag(&self, from: (i16, i16), to: (i16, i16)) -> Outcome<()> {
        let pause = || sleep(Duration::from_millis(40));
        self.input(MOTION_NOTIFY_EVENT, 0, from)?;
        pause();
        self.input(BUTTON_PRESS_EVENT, 1, from)?;
        for step in 1..=10 {
            pause();
            let between = |from: i16, to: i16| from + (to - from) * step / 10;
            self.input(MOTION_NOTIFY_EVENT, 0, (between(from.0, to.0), between(from.1, to.1)))?;
        }
        pause();
        self.input(BUTTON_RELEASE_EVENT, 1, to)
    }

    fn input(&self, kind: u8, detail: u8, (x, y): (i16, i16)) -> Outcome<()> {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0)?;
        Ok(self.connection.flush()?)
    }

    /// Asks the window to close, as a window manager does. Returns how the process ended, and after what
    /// time.
    pub(crate) fn close(mut self, window: Window) -> Outcome<(ExitStatus, Duration)> {
        let atom = |name: &[u8]| {
            Ok::<_, Box<dyn Error>>(self.connection.intern_atom(false, name)?.reply()?.atom)
        };
        let (protocols, delete) = (atom(b"WM_PROTOCOLS")?, atom(b"WM_DELETE_WINDOW")?);
        let known = self.connection.get_property(false, window, protocols, AtomEnum::ATOM, 0, 8)?;
        let known: Vec<_> = known.reply()?.value32().ok_or("atoms")?.collect();
        if !known.contains(&delete) {
            return Err("the window cannot be asked to close".into());
        }
        let event = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
        self.connection.send_event(false, window, EventMask::NO_EVENT, event)?;
        self.connection.flush()?;
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            if let Some(status) = self.process.0.try_wait()? {
                return Ok((status, begin.elapsed()));
            }
            sleep(Duration::from_millis(5));
        }
        Err("it does not end".into())
    }
}
