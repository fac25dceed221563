//! What the tests share: an opener of bench scenes, and a window in egui's harness.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bench_scenes::{Moving, load_as};
use egui_kittest::Harness;
use metaball::{Backend, BoxError, DrawOptions, Drawing, Overrides, ReadOptions, draw};
use viewer::{Content, Opener, Stage, Start, Subject, Threads, Viewer, Window};

/// Threads beside the window may take this long on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// Points across and down of the whole window.
pub(crate) const SIZE: [f32; 2] = [700.0, 420.0];

/// Opens bench scenes; `splash` with its frames.
pub(crate) struct Bench;

impl Opener for Bench {
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError> {
        let (name, camera, content);
        let (mut notes, mut legend) = (None, None);
        if spec == "splash" {
            let splash = Moving::load(spec, &Overrides::default())?;
            (name, camera) = (splash.name.clone(), splash.camera);
            content = Content::Moving(Box::new(splash));
        } else {
            let bench = load_as(spec, reading, &Overrides::default())?;
            (name, camera, content) = (bench.name, bench.camera, Content::Still(bench.scene));
            if let Some(file) = bench.file {
                (notes, legend) = (Some(file.notes), file.legend);
            }
        }
        let (spec, inputs) = (spec.to_owned(), bench_scenes::inputs(spec));
        let reading = reading.clone();
        Ok(Subject { spec, name, camera, notes, legend, inputs, reading, content })
    }
}

pub(crate) fn start(spec: &str) -> Start {
    Start { spec: Some(spec.to_owned()), ..Start::default() }
}

/// A window on a scene.
pub(crate) fn window(spec: &str) -> Harness<'static, Window> {
    window_of(Arc::new(Bench), start(spec))
}

pub(crate) fn window_of(opener: Arc<dyn Opener>, start: Start) -> Harness<'static, Window> {
    let woken = Arc::new(AtomicBool::new(false));
    let wake: viewer::Wake = Arc::new(move || woken.store(true, Ordering::Relaxed));
    let window = Window::new(Viewer::new(opener, Arc::new(Threads), start, &wake));
    Harness::builder()
        .with_size(SIZE)
        .build_ui_state(|ui, window: &mut Window| window.show(ui), window)
}

/// Shows frame after frame until it is so of the viewer.
pub(crate) fn until(harness: &mut Harness<'_, Window>, is_so: impl Fn(&Viewer) -> bool) {
    until_it(harness, |window| is_so(window.viewer()));
}

/// Shows frame after frame until it is so.
pub(crate) fn until_it(harness: &mut Harness<'_, Window>, is_so: impl Fn(&Window) -> bool) {
    let begin = Instant::now();
    while !is_so(harness.state()) {
        assert!(begin.elapsed() < PATIENCE, "it never is");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
}

/// Until a sharp picture of the latest camera, model and size is there.
pub(crate) fn until_sharp(harness: &mut Harness<'_, Window>) {
    until(harness, |viewer| {
        viewer.painting().is_some_and(|painting| {
            let (width, height) = (painting.view.width(), painting.view.height());
            painting.stage != Stage::Coarse
                && viewer.camera() == Some(*painting.view.camera())
                && viewer.size() == Some((width, height))
                && viewer.model().is_some_and(|model| std::ptr::eq(model, &*painting.model))
        })
    });
}

/// What `render` draws of what the window shows.
pub(crate) fn rendered(viewer: &Viewer) -> Drawing {
    let (subject, model) = (viewer.subject().expect("open"), viewer.model().expect("built"));
    let options = DrawOptions {
        method: model.method().clone(),
        size: viewer.size().expect("drawn"),
        viewpoint: viewer.viewpoint(),
        picture: viewer.look().picture,
        clip: viewer.look().clip.clone(),
        light: viewer.look().light.clone(),
        backend: Backend::Cpu,
    };
    draw(model.scene(), &subject.camera, &options).expect("drawn")
}

/// Holds the sharp picture against it.
pub(crate) fn assert_rendered(harness: &mut Harness<'_, Window>) {
    until_sharp(harness);
    let viewer = harness.state().viewer();
    let (painting, wanted) = (viewer.painting().expect("sharp"), rendered(viewer));
    assert!(wanted.hit_count() > 100, "something is to be seen");
    assert!(painting.shown.hits == wanted.hits, "the same verdicts, distances and normals");
    assert!(painting.shown.image == wanted.image, "the same pixels");
}
