//! Scene files: TOML that names a particle file and says how its balls make a surface (`FORMATS.md` has the
//! keys).

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use metaball_core::{Camera, Kernel};
use serde::Deserialize;
use toml::Spanned;

use crate::error::{Flaw, LoadError, Location};
use crate::file;
use crate::formula::FormulaOptions;
use crate::overrides::kernel_named;
use crate::text::utf8;

/// What a scene file says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SceneFile {
    /// Path of the particle file: as written, or from where the scene file is once that is known.
    pub(crate) particles: PathBuf,
    /// `None` for the default, or the formula's.
    pub(crate) kernel: Option<Kernel>,
    /// `None` for the default, or the formula's.
    pub(crate) threshold: Option<f32>,
    pub(crate) formula: FormulaOptions,
    /// `None` for one that frames the particles.
    pub(crate) camera: Option<SceneCamera>,
}

/// A camera in the coordinates of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SceneCamera {
    eye: DVec3,
    look_at: DVec3,
    up: Option<Vec3>,
    vertical_fov_degrees: f32,
    /// Where it stands in its file.
    location: Location,
}

impl SceneCamera {
    /// The camera of a scene whose coordinates begin at `origin`.
    pub(crate) fn at(&self, origin: DVec3) -> Result<Camera, Flaw> {
        let [eye, look_at] = [self.eye, self.look_at].map(|point| (point - origin).as_vec3());
        let degrees = self.vertical_fov_degrees;
        match self.up {
            Some(up) => Camera::look_at(eye, look_at, up, degrees),
            None => Camera::upright(eye, look_at, degrees),
        }
        .map_err(|error| Flaw { location: self.location.clone(), problem: error.to_string() })
    }
}

impl SceneFile {
    /// What the name of a scene file ends in.
    pub(crate) const ENDING: &'static str = "toml";

    /// Reads a scene file. The particle file that it names is not opened.
    pub(crate) fn open(path: &Path) -> Result<Self, LoadError> {
        let named = path.display().to_string();
        let bytes = file::read(path)?;
        let scene_file = utf8(&bytes).and_then(parse).map_err(|flaw| flaw.in_file(&named))?;
        if file::ending(&scene_file.particles).as_deref() == Some(Self::ENDING) {
            let needed = "a file of particles, not another scene file";
            let flaw = Flaw::needed(needed, format_args!("{:?}", scene_file.particles));
            return Err(flaw.at_key("particles").in_file(&named));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self { particles: folder.join(&scene_file.particles), ..scene_file })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    particles: String,
    kernel: Option<Spanned<String>>,
    exponent: Option<Spanned<i64>>,
    threshold: Option<Spanned<f32>>,
    #[serde(default)]
    sph: bool,
    preset: Option<Spanned<String>>,
    support_per_h: Option<f64>,
    particle_mass: Option<f64>,
    resolution: Option<f64>,
    radius_offset: Option<f64>,
    smoothness: Option<f64>,
    smoothing_length: Option<f64>,
    camera: Option<Spanned<CameraKeys>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraKeys {
    eye: [f64; 3],
    look_at: [f64; 3],
    up: Option<[f32; 3]>,
    #[serde(default = "field_of_view")]
    vertical_fov_degrees: f32,
}

fn field_of_view() -> f32 {
    38.0
}

/// Reads a scene file's text.
fn parse(text: &str) -> Result<SceneFile, Flaw> {
    let keys: Keys = toml::from_str(text).map_err(|error| {
        let flaw = Flaw::new(error.message());
        // A folder of Windows in double quotes.
        let flaw = match error.message().contains("escape") {
            true => flaw.or("write / for \\, or put the path in single quotes"),
            false => flaw,
        };
        match error.span() {
            Some(span) => at(flaw, text, span.start),
            None => flaw,
        }
    })?;

    if keys.particles.is_empty() {
        let needed = "a file of particles, from the folder of the scene file on";
        return Err(Flaw::needed(needed, "no name").at_key("particles"));
    }
    let threshold = match &keys.threshold {
        Some(value) if !(value.get_ref().is_finite() && *value.get_ref() > 0.0) => {
            let flaw = Flaw::needed("a finite number above 0", value.get_ref());
            return Err(at(flaw.at_key("threshold"), text, value.span().start));
        }
        value => value.as_ref().map(|value| *value.get_ref()),
    };
    Ok(SceneFile {
        kernel: kernel(&keys, text)?,
        threshold,
        formula: formula(&keys, text)?,
        camera: keys.camera.as_ref().map(|camera| camera_of(camera, text)).transpose()?,
        particles: keys.particles.into(),
    })
}

fn kernel(keys: &Keys, text: &str) -> Result<Option<Kernel>, Flaw> {
    let flaw = |error: &LoadError, key: &str, byte: usize| {
        at(Flaw::new(error.to_string()).at_key(key), text, byte)
    };
    let name = keys.kernel.as_ref();
    let own = name.map(|name| {
        let start = name.span().start;
        kernel_named(name.get_ref(), None).map_err(|error| flaw(&error, "kernel", start))
    });
    let own = own.transpose()?;
    let Some(exponent) = &keys.exponent else { return Ok(own) };
    let name = name.map_or("power", |name| name.get_ref());
    kernel_named(name, Some(*exponent.get_ref()))
        .map(Some)
        .map_err(|error| flaw(&error, "exponent", exponent.span().start))
}

fn formula(keys: &Keys, text: &str) -> Result<FormulaOptions, Flaw> {
    let flaw = |error: LoadError| Flaw::new(error.to_string());
    let preset = keys.preset.as_ref().map(|name| {
        let flaw = |error| at(flaw(error).at_key("preset"), text, name.span().start);
        name.get_ref().parse().map_err(flaw)
    });
    let options = FormulaOptions {
        sph: keys.sph,
        preset: preset.transpose()?,
        support_per_h: keys.support_per_h,
        particle_mass: keys.particle_mass,
        resolution: keys.resolution,
        radius_offset: keys.radius_offset,
        smoothness: keys.smoothness,
        smoothing_length: keys.smoothing_length,
    };
    options.formula().map(|_| options).map_err(flaw)
}

fn camera_of(keys: &Spanned<CameraKeys>, text: &str) -> Result<SceneCamera, Flaw> {
    let CameraKeys { eye, look_at, up, vertical_fov_degrees } = *keys.get_ref();
    let camera = SceneCamera {
        eye: eye.into(),
        look_at: look_at.into(),
        up: up.map(Vec3::from_array),
        vertical_fov_degrees,
        location: at(Flaw::new(""), text, keys.span().start).location,
    };
    // Whatever is wrong with it is wrong at any origin.
    camera.at(camera.look_at).map(|_| camera)
}

/// The flaw at a byte of the text.
fn at(flaw: Flaw, text: &str, byte: usize) -> Flaw {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = 1 + before.matches('\n').count();
    flaw.at_line(line).at_column(1 + before[line_start..].chars().count())
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;

    const FULL: &str = r#"
particles = "pool.csv"
kernel = "power"
exponent = 3
threshold = 0.2
[camera]
eye = [2.2, 1.7, 3.4]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
vertical_fov_degrees = 40
"#;

    #[test]
    fn names_that_are_none_are_refused_with_a_way_out() {
        let windows = refusal("particles = \"C:\\data\\a.csv\"");
        assert!(windows.contains("line 1") && windows.ends_with("in single quotes"), "{windows}");
        assert!(refusal("particles = \"\"").contains("needed a file of particles"));
    }

    fn refusal(text: &str) -> String {
        parse(text).expect_err("refused").in_file("a.toml").to_string()
    }

    #[test]
    fn every_key_is_read() {
        let file = parse(FULL).expect("legal");
        assert_eq!(file.particles, Path::new("pool.csv"));
        let cubic = Kernel::power(3).expect("legal");
        assert_eq!((file.kernel, file.threshold), (Some(cubic), Some(0.2)));
        let camera = |eye, look_at| Camera::look_at(eye, look_at, Vec3::Y, 40.0).expect("legal");
        let at = |origin| file.camera.as_ref().expect("a camera").at(origin).expect("legal");
        assert_eq!(at(DVec3::ZERO), camera(Vec3::new(2.2, 1.7, 3.4), Vec3::ZERO));
        assert_eq!(at(DVec3::Y).eye(), Vec3::new(2.2, 0.7, 3.4));
    }

    #[test]
    fn only_the_particles_are_required() {
        let file = parse("particles = 'a.xyz'").expect("legal");
        assert_eq!((file.kernel, file.threshold, file.camera), (None, None, None));
        let wyvill = parse("particles = 'a.xyz'\nkernel = 'wyvill'").expect("legal");
        assert_eq!(wyvill.kernel, Some(Kernel::Wyvill));
        let gaussian = parse("particles = 'a.xyz'\nkernel = 'gaussian-2.5'").expect("legal");
        assert_eq!(gaussian.kernel, Kernel::gaussian(2.5).ok());
        assert!(refusal("kernel = 'wyvill'").contains("missing field `particles`"));
    }

    #[test]
    fn formulas_are_read() {
        let text = "particles = 'a.pdb'\npreset = 'molmap'\nresolution = 3\nkernel = 'gaussian-4'";
        let file = parse(text).expect("legal");
        assert_eq!(file.formula.resolution, Some(3.0));
        assert_eq!(file.kernel, Kernel::gaussian(4.0).ok());
        let sph = parse("particles = 'a.vtu'\nsph = true\nsupport_per_h = 1").expect("legal");
        assert!(sph.formula.sph && sph.formula.support_per_h == Some(1.0));
        let unknown = refusal("particles = 'a.pdb'\npreset = 'vmd'");
        assert!(
            unknown.starts_with("a.toml, line 2, column 10 (preset): preset: needed quick"),
            "{unknown}"
        );
        let other = refusal("particles = 'a.pdb'\npreset = 'quicksurf'\nsmoothness = 2.0");
        assert_eq!(
            other,
            "a.toml: smoothness: needed the preset gaussian-surface, whose it is, found the preset quicksurf"
        );
    }

    #[test]
    fn refusals_name_line_column_and_key() {
        let with = |from: &str, to: &str| refusal(&FULL.replace(from, to));
        assert!(
            with("threshold", "treshold")
                .starts_with("a.toml, line 5, column 1: unknown field `treshold`")
        );
        assert_eq!(
            with("0.2\n", "-1.0\n"),
            "a.toml, line 5, column 13 (threshold): needed a finite number above 0, found -1"
        );
        assert_eq!(
            with("\"power\"", "\"gauss\""),
            format!(
                "a.toml, line 3, column 10 (kernel): kernel: needed {}, found \"gauss\"",
                Kernel::NAMES
            )
        );
        assert_eq!(
            with("exponent = 3", "exponent = 9"),
            "a.toml, line 4, column 12 (exponent): kernel exponent: needed an integer from 1 to 8, \
             found 9"
        );
        assert_eq!(
            with("\"power\"", "\"wyvill\""),
            "a.toml, line 4, column 12 (exponent): kernel exponent: needed the kernel power, found \
             \"wyvill\""
        );
        assert!(with("up = [0.0, 1.0, 0.0]", "up = [2.2, 1.7, 3.4]").contains("camera up: needed"));
        let from_above = FULL.replace("[2.2, 1.7, 3.4]", "[0.0, 9.0, 0.0]");
        assert!(refusal(&from_above).contains("camera up: needed"));
        let upright = parse(&from_above.replace("up = [0.0, 1.0, 0.0]", "")).expect("legal");
        assert!(upright.camera.expect("a camera").at(DVec3::ZERO).expect("legal").up().z > 0.99);
        assert!(with("[2.2, 1.7, 3.4]", "[2.2, 1.7]").starts_with("a.toml, line 7, column 7:"));
        assert!(with("0.2\n", "\n").starts_with("a.toml, line 5"));
        assert!(with("eye", "eyes").contains("unknown field `eyes`"));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in any::<String>()) {
            let _ = parse(&text);
        }

        #[test]
        fn no_mutated_file_panics(at in 0..FULL.len(), insert in "[\\[\\]\"a-z0-9.=\n-]{0,3}", cut in 0..5usize) {
            let end = (at + cut).min(FULL.len());
            let _ = parse(&[&FULL[..at], &insert, &FULL[end..]].concat());
        }
    }
}
