//! Files of what is seen, drawn by the library beside the window.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use metaball::{
    Backend, Camera, DrawOptions, Error, Legend, Model, Outputs, Progress, Stage, Viewpoint,
    draw_to_files,
};

use crate::crew::Crew;
use crate::events::Post;
use crate::painter::Look;
use crate::subject::told;

/// What is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Export {
    /// Where the picture goes: `.png`, `.jpg` or `.jpeg`.
    pub image: PathBuf,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Whether an OpenEXR file, named like the picture, is written too: the light where there is ray
    /// traced light, else distances and normals.
    pub exr: bool,
}

/// A picture that is being written.
#[derive(Debug)]
pub(crate) struct Exporting {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    done: AtomicU32,
    of: AtomicU32,
    stopped: AtomicBool,
}

/// All that a picture is of.
pub(crate) struct Job {
    pub(crate) model: Arc<Model>,
    /// The scene's own camera.
    pub(crate) camera: Camera,
    pub(crate) viewpoint: Viewpoint,
    pub(crate) look: Look,
    pub(crate) legend: Option<Legend>,
    pub(crate) inputs: Vec<PathBuf>,
    pub(crate) export: Export,
}

impl Exporting {
    /// Begins beside all else; what is written is reported, or why it is not.
    pub(crate) fn new(crew: &dyn Crew, job: Job, post: Post<Result<String, String>>) -> Self {
        let shared = Arc::new(Shared::default());
        let counts = shared.clone();
        crew.begin(Box::new(move || {
            Box::pin(async move {
                let written = job.write(&counts, || post.wake());
                post.send(written.map_err(|error| told(&error)));
            })
        }));
        Self { shared }
    }

    /// The share that is done, 0 to 1.
    pub(crate) fn progress(&self) -> f32 {
        let [done, of] =
            [&self.shared.done, &self.shared.of].map(|count| count.load(Ordering::Relaxed));
        done as f32 / of.max(1) as f32
    }

    /// Breaks it off. What is finished stays in a spool beside the picture, from which the same picture
    /// goes on.
    pub(crate) fn stop(&self) {
        self.shared.stopped.store(true, Ordering::Relaxed);
    }
}

impl Drop for Exporting {
    fn drop(&mut self) {
        self.stop();
    }
}

impl Job {
    fn write(&self, shared: &Shared, wake: impl Fn()) -> Result<String, Error> {
        let mut outputs = self.outputs()?;
        let options = DrawOptions {
            method: self.model.method().clone(),
            size: self.export.size,
            viewpoint: self.viewpoint,
            picture: self.look.picture,
            clip: self.look.clip.clone(),
            light: self.look.light.clone(),
            backend: Backend::Cpu,
        };
        let watch = |progress: Progress| {
            if progress.stage == Stage::Drawing {
                shared.of.store(progress.of, Ordering::Relaxed);
                shared.done.store(progress.done, Ordering::Relaxed);
                wake();
            }
            match shared.stopped.load(Ordering::Relaxed) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let scene = self.model.scene();
        let drawn = draw_to_files(scene, &self.camera, &options, &outputs, watch);
        if let Err(Error::OtherPicture { .. }) = drawn {
            outputs.resume = false;
            draw_to_files(scene, &self.camera, &options, &outputs, watch)?;
        } else {
            drawn?;
        }
        Ok(self.export.image.display().to_string())
    }

    fn outputs(&self) -> Result<Outputs, Error> {
        let Export { image, exr, .. } = &self.export;
        let is_lit = self.look.light.is_asked();
        let exr = exr.then(|| image.with_extension("exr"));
        let outputs = Outputs {
            hits: exr.clone().filter(|_| !is_lit),
            light: exr.filter(|_| is_lit),
            resume: true,
            inputs: self.inputs.clone(),
            ..Outputs::image(image)
        };
        match &self.legend {
            Some(legend) => outputs.with_legend(legend),
            None => Ok(outputs),
        }
    }
}
