//! The commands that draw pictures: `render` and `animate`.

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Context, ensure};
use bench_scenes::Overrides;
use clap::Args;
use harness::animate::{self, animate};
use harness::auto::MAX_ERROR;
use harness::auto::cache::Cache;
use harness::camera::CameraOptions;
use harness::light::LightOptions;
use harness::methods::find;
use harness::picture::{color_of, picture_named};
use harness::render::{Choosing, Device, Drawing, Order, render};
use metaball_core::Color;
use metaball_core::gpu::Picture;
use particle_files::NumberedPath;

use crate::names::{AUTO, DEFAULT_METHOD, drawer_parser};
use crate::shared::PictureArgs;
use crate::values;

/// What to draw, and how.
#[derive(Debug, Args)]
pub(crate) struct DrawingArgs {
    /// A known name, a generator such as scattered:50000, or a file; for animate one that moves, such
    /// as tornado:4000 or particles-%04d.xyz.
    scene: String,
    /// The method; fbvh-certified when left out. For render, auto chooses: see --max-error.
    #[arg(long, value_name = "NAME", value_parser = drawer_parser())]
    method: Option<String>,
    /// What the picture shows: phong, normal, depth, color, spheres, or work:COUNTER.
    #[arg(long, value_name = "WHAT", default_value = "phong", value_parser = picture_named)]
    picture: Picture,
    /// Trace on the CPU, without a graphics adapter: what happens anyway where there is none.
    #[arg(long, conflicts_with_all = ["adapter", "software"])]
    cpu: bool,
    /// One colour for all balls, sRGB, 0 to 1; the scene's own, or white, when left out.
    #[arg(long, value_name = "R,G,B", value_parser = color_of)]
    color: Option<Color>,
    #[command(flatten)]
    camera: CameraOptions,
    #[command(flatten)]
    light: LightOptions,
    #[command(flatten)]
    shared: PictureArgs,
}

impl DrawingArgs {
    /// With the default method where another is chosen in its place.
    fn drawing(self) -> anyhow::Result<Drawing> {
        let Self { scene, method, picture, cpu, color, camera, light, shared } = self;
        let name = method.as_deref().filter(|&name| name != AUTO).unwrap_or(DEFAULT_METHOD);
        let method = find(name).with_context(|| format!("no method is called {name}"))?;
        let (overrides, size) = (Overrides { color, ..shared.overrides() }, shared.size);
        let device = if cpu { Device::Cpu } else { Device::Adapter(shared.device.choice()) };
        Ok(Drawing { scene, overrides, method, size, camera, picture, light, device })
    }
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// Draw with the quickest method and options whose error on this scene is at most so many mean
    /// support radii for 99 of 100 hits, with no wrong verdict [default of auto: 1e-3].
    #[arg(long, value_name = "E", value_parser = values::max_error)]
    max_error: Option<f64>,
    /// With auto, neither look for a choice made earlier nor keep the one made now.
    #[arg(long)]
    ignore_cache: bool,
    /// Where the PNG goes.
    #[arg(long, value_name = "FILE", default_value = "out/image.png")]
    out: PathBuf,
    /// Write distances (Z) and normals (N.X, N.Y, N.Z) as f32 channels of an OpenEXR file too.
    #[arg(long, value_name = "FILE")]
    hits: Option<PathBuf>,
    /// Write the picture's linear light as an OpenEXR file too.
    #[arg(long, value_name = "FILE", requires = "LightOptions")]
    light_out: Option<PathBuf>,
}

impl RenderArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let auto = self.choosing()?;
        let Self { drawing, out, hits, light_out, .. } = self;
        render(&Order { drawing: drawing.drawing()?, auto, out, hits, light_out })
    }

    /// Whether to choose who draws; an error is asked of `auto` alone.
    fn choosing(&self) -> anyhow::Result<Option<Choosing>> {
        let (name, max_error) = (self.drawing.method.as_deref(), self.max_error);
        if name == Some(AUTO) || (name.is_none() && max_error.is_some()) {
            let cache = if self.ignore_cache { Cache::none() } else { Cache::of_user() };
            return Ok(Some(Choosing { max_error: max_error.unwrap_or(MAX_ERROR), cache }));
        }
        let name = name.unwrap_or(DEFAULT_METHOD);
        ensure!(max_error.is_none(), "--max-error: needed --method auto, found --method {name}");
        ensure!(!self.ignore_cache, "--ignore-cache: needed --method auto, found --method {name}");
        Ok(None)
    }
}

#[derive(Debug, Args)]
pub(crate) struct AnimateArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// Frames, the last one not included; all, or the first seconds of what goes on for ever.
    #[arg(long, value_name = "A..B", value_parser = values::frame_range)]
    frames: Option<Range<u32>>,
    /// Draw every Nth of them.
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Where the PNGs go: %d stands for the frame's number, %04d for four digits or more.
    #[arg(long, value_name = "FILE", default_value = "out/frame-%04d.png")]
    out: NumberedPath,
    /// Write a picture of all these frames side by side too.
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
    /// Draw all frames, those that are there too.
    #[arg(long)]
    force: bool,
    /// Build for a frame only after the one before has been drawn, not meanwhile.
    #[arg(long)]
    in_turn: bool,
}

impl AnimateArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        let Self { drawing, frames, every, out, sheet, force, in_turn } = self;
        ensure!(
            drawing.method.as_deref() != Some(AUTO),
            "auto chooses for one picture: for frames name a method"
        );
        let drawing = drawing.drawing()?;
        animate(&animate::Order { drawing, frames, every, out, sheet, force, in_turn })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Command, parse};

    #[test]
    fn an_error_asks_for_auto() {
        let chosen = |line: &str| {
            let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
            render.choosing()
        };
        let error = |line| chosen(line).expect("consistent").map(|choosing| choosing.max_error);
        assert_eq!(error("metaball render molecule"), None);
        assert_eq!(error("metaball render molecule --method illes"), None);
        assert_eq!(error("metaball render molecule --method auto"), Some(MAX_ERROR));
        assert_eq!(error("metaball render molecule --max-error 0.05"), Some(0.05));
        let line = "metaball render molecule --method illes --max-error 0.05";
        assert!(chosen(line).expect_err("a contradiction").to_string().contains("auto"));
        assert!(parse("metaball render molecule --max-error 0").is_err());
        assert!(parse("metaball render molecule --max-error NaN").is_err());
    }
}
