//! The command lines that draw what the window shows.

use std::fmt;

use glam::{DVec3, Vec3};
use metaball::{Clip, FloorKind, LightOptions, Overrides, Picture, ReadOptions, Viewpoint};

/// The words of a command line. Displayed, they are quoted where a POSIX shell wants it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CommandLine {
    words: Vec<String>,
}

impl CommandLine {
    /// One that begins with these words.
    pub fn new(words: &[&str]) -> Self {
        Self { words: words.iter().map(|word| (*word).to_owned()).collect() }
    }

    /// The words, unquoted.
    pub fn words(&self) -> &[String] {
        &self.words
    }

    /// With a flag behind that has no value.
    #[must_use]
    pub fn switch(mut self, name: &str, is_on: bool) -> Self {
        if is_on {
            self.words.push(format!("--{name}"));
        }
        self
    }

    /// With a flag and its value behind, if it has one. They are one word, since a value may begin with a
    /// hyphen.
    #[must_use]
    pub fn flag(mut self, name: &str, value: Option<impl fmt::Display>) -> Self {
        self.words.extend(value.map(|value| format!("--{name}={value}")));
        self
    }

    /// With the flags of a camera behind: none for the scene's own.
    #[must_use]
    pub fn viewpoint(self, &Viewpoint { eye, look_at, up, fov }: &Viewpoint) -> Self {
        self.flag("eye", eye.map(point))
            .flag("look-at", look_at.map(point))
            .flag("up", up.map(vector))
            .flag("fov", fov)
    }

    /// With those of kernel, threshold and colour.
    #[must_use]
    pub fn field(self, field: &Overrides) -> Self {
        let share = |channel: u8| f64::from(channel) / 255.0;
        let color = field.color.map(|color| point(color.to_srgb().map(share).into()));
        self.flag("kernel", field.kernel)
            .flag("exponent", field.exponent)
            .flag("threshold", field.threshold)
            .flag("color", color)
    }

    /// With those of reading a file.
    #[must_use]
    pub fn reading(self, reading: &ReadOptions) -> Self {
        let topology = reading.topology.as_ref().map(|path| path.display());
        let line = self
            .flag("as", reading.substance)
            .flag("radius", reading.radius)
            .flag("support-radius", reading.support_radius)
            .flag("radius-scale", reading.radius_scale)
            .flag("units", reading.units)
            .flag("frame", reading.frame)
            .flag("model", reading.model)
            .flag("topology", topology)
            .flag("columns", reading.columns.as_ref().map(|names| names.join(",")));
        let keep = &reading.selection.keep;
        let line = keep.iter().fold(line, |line, rule| line.flag("keep", Some(rule)));
        let drop = &reading.selection.drop;
        let line = drop.iter().fold(line, |line, rule| line.flag("drop", Some(rule)));
        line.flag("color-by", reading.color_by.as_ref())
            .flag("repeat", reading.repeat.map(|[x, y, z]| format!("{x},{y},{z}")))
            .switch("periodic", reading.periodic)
            .switch("frame-all", reading.frame_all)
    }

    /// With that of what a picture shows.
    #[must_use]
    pub fn picture(self, picture: Picture) -> Self {
        let name = match picture {
            Picture::Phong => None,
            Picture::Normal => Some("normal".to_owned()),
            Picture::Depth => Some("depth".to_owned()),
            Picture::Color => Some("color".to_owned()),
            Picture::Spheres => Some("spheres".to_owned()),
            Picture::Work(kind) => Some(format!("work:{}", kind.to_string().replace(' ', "-"))),
        };
        self.flag("picture", name)
    }

    /// With those of a region.
    #[must_use]
    pub fn clip(self, clip: &Clip) -> Self {
        clip.planes().fold(self, |line, (normal, offset)| {
            line.flag("clip", Some(format!("{},{offset}", vector(normal))))
        })
    }

    /// With those of light.
    #[must_use]
    pub fn light(self, light: &LightOptions) -> Self {
        let lamps = light.lamps.iter();
        let line = lamps.fold(self.switch("shadows", light.shadows), |line, lamp| {
            line.flag("lamp", Some(vector(*lamp)))
        });
        let floor = light.floor.map(|floor| match floor {
            FloorKind::Plain => "plain",
            FloorKind::Tiles => "tiles",
        });
        line.flag("lamp-size", light.lamp_size)
            .flag("ambient-occlusion", light.ambient_occlusion)
            .flag("occlusion-reach", light.occlusion_reach)
            .flag("reflections", light.reflections)
            .flag("reflectivity", light.reflectivity)
            .flag("refraction", light.refraction)
            .flag("absorption", light.absorption.map(vector))
            .flag("opacity", light.opacity)
            .flag("bounces", light.bounces)
            .flag("floor", floor)
            .flag("environment", light.environment.as_ref().map(|path| path.display()))
            .flag("cel", light.cel)
            .flag("depth-cue", light.depth_cue)
            .flag("samples", light.samples)
            .flag("seed", light.seed)
            .flag("exposure", light.exposure)
    }
}

impl fmt::Display for CommandLine {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<_> = self.words.iter().map(|word| quoted(word)).collect();
        formatter.write_str(&words.join(" "))
    }
}

fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_=,./:+%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

fn point(point: DVec3) -> String {
    format!("{},{},{}", point.x, point.y, point.z)
}

fn vector(vector: Vec3) -> String {
    format!("{},{},{}", vector.x, vector.y, vector.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_asked_for_is_written() {
        let line = CommandLine::new(&["metaball", "render", "molecule"])
            .reading(&ReadOptions::default())
            .field(&Overrides::default())
            .viewpoint(&Viewpoint::default())
            .picture(Picture::Phong)
            .clip(&Clip::default())
            .light(&LightOptions::default());
        assert_eq!(line.to_string(), "metaball render molecule");
        let line = line.viewpoint(&Viewpoint { fov: Some(30.5), ..Viewpoint::default() });
        let line = line.clip(&Clip::default().and_plane(-Vec3::X, 0.25).expect("a plane"));
        assert_eq!(line.to_string(), "metaball render molecule --fov=30.5 --clip=-1,-0,-0,0.25");
    }

    #[test]
    fn words_are_quoted_where_a_shell_wants_it() {
        let line = CommandLine::new(&["metaball", "it's here.xyz", ""]);
        assert_eq!(line.to_string(), r"metaball 'it'\''s here.xyz' ''");
    }
}
