//! What a user does on the page, as the page tells it to its worker.

use glam::{DVec3, Vec3};
use metaball::{ColorBy, FloorKind, LightOptions, Overrides, Picture, ReadOptions};
use metaball_core::Kernel;
use serde::{Deserialize, Serialize};
use viewer::cut::cut;
use viewer::{Look, Material};

use crate::front::Front;

/// One act. Places are from the top left of the picture, each from 0 to 1; ways are in heights of it, to the
/// right and down.
#[derive(Debug, Deserialize)]
#[serde(tag = "act", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Act {
    /// The picture has another size, in pixels.
    Resize { width: u32, height: u32 },
    /// A hand takes hold of a place.
    Grab { at: (f64, f64) },
    /// And lets go.
    Release,
    /// Turns about the middle.
    Turn { by: (f64, f64) },
    /// Moves along with the hand.
    Slide { by: (f64, f64) },
    /// Rolls about the direction of view, radians.
    Roll { by: f64 },
    /// Leaves a share of the distance to a place.
    Zoom { at: (f64, f64), share: f64 },
    /// Asks what a place is made of; or looks at it.
    Pick { at: (f64, f64), centre: bool },
    /// Forgets what was picked.
    Forget,
    /// Back to where it was first seen from.
    Home,
    /// Looks along an axis.
    Along { axis: [f64; 3] },
    /// Gives up what is being read or built.
    Cancel,
    /// Another kernel, by its name.
    Kernel { name: String },
    /// Another threshold.
    Threshold { value: f32 },
    /// The scene's own kernel and threshold.
    OwnField,
    /// Reads the file again, otherwise.
    Read { radius_scale: Option<f32>, color_by: Option<String>, frame: Option<u32> },
    /// Shows something else of it.
    Show { picture: Shown },
    /// Another light.
    Light(Light),
    /// Cuts by a plane in the place of the last one, or by none.
    Cut { plane: Option<([f32; 3], f64)> },
}

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Shown {
    Surface,
    Normals,
    Distances,
    Colours,
}

/// The light, as the page has it.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Light {
    pub(crate) shadows: bool,
    /// Degrees across the lamps.
    pub(crate) lamp_size: f32,
    pub(crate) occlusion: bool,
    /// One of [`Material`]'s names.
    pub(crate) material: String,
    /// `plain`, `tiles` or nothing.
    pub(crate) floor: String,
    pub(crate) exposure: f32,
    pub(crate) samples: u32,
}

impl Act {
    /// Does it.
    pub(crate) fn perform(self, front: &mut Front) {
        let Front { viewer, hand, picks, held, .. } = front;
        match self {
            Self::Resize { width, height } => front.size = (width.max(1), height.max(1)),
            Self::Grab { at } => {
                hand.grab(viewer, at);
                *held = true;
            }
            Self::Release => *held = false,
            Self::Turn { by: (right, down) } => hand.turn(viewer, right, down),
            Self::Slide { by: (right, down) } => hand.slide(viewer, right, down),
            Self::Roll { by } => pose(front, |pose| pose.rolled(by)),
            Self::Zoom { at, share } => hand.zoom(viewer, at, share),
            Self::Pick { at, centre } => front.pick(at, centre),
            Self::Forget => picks.clear(),
            Self::Home => viewer.go_home(),
            Self::Along { axis } => pose(front, |pose| pose.seen_from(DVec3::from(axis))),
            Self::Cancel => viewer.cancel(),
            Self::Kernel { name } => {
                let kernel = Kernel::all().find(|kernel| kernel.to_string() == name);
                let field = *viewer.field();
                viewer.set_field(Overrides { kernel, exponent: None, ..field });
            }
            Self::Threshold { value } => {
                let field = *viewer.field();
                viewer.set_field(Overrides { threshold: Some(value), ..field });
            }
            Self::OwnField => viewer.set_field(Overrides::default()),
            Self::Read { radius_scale, color_by, frame } => {
                let color_by = color_by.as_deref().map(str::parse::<ColorBy>).transpose();
                match color_by {
                    Ok(color_by) => viewer.read_as(ReadOptions {
                        radius_scale,
                        color_by,
                        frame,
                        ..viewer.reading().clone()
                    }),
                    Err(error) => front.refusal = Some(error.to_string()),
                }
            }
            Self::Show { picture } => {
                let picture = picture.picture();
                viewer.set_look(Look { picture, ..viewer.look().clone() });
            }
            Self::Light(light) => {
                let light = light.options();
                viewer.set_look(Look { light, ..viewer.look().clone() });
            }
            Self::Cut { plane } => {
                cut(viewer, plane.map(|(normal, offset)| (Vec3::from(normal), offset)));
            }
        }
    }
}

/// Moves the eye.
fn pose(front: &mut Front, moved: impl FnOnce(viewer::Pose) -> viewer::Pose) {
    if let Some(pose) = front.viewer.pose() {
        front.viewer.set_pose(moved(pose));
    }
}

impl Shown {
    pub(crate) fn of(picture: Picture) -> Self {
        match picture {
            Picture::Normal => Self::Normals,
            Picture::Depth => Self::Distances,
            Picture::Color => Self::Colours,
            _ => Self::Surface,
        }
    }

    fn picture(self) -> Picture {
        match self {
            Self::Surface => Picture::Phong,
            Self::Normals => Picture::Normal,
            Self::Distances => Picture::Depth,
            Self::Colours => Picture::Color,
        }
    }
}

impl Light {
    pub(crate) fn of(light: &LightOptions) -> Self {
        Self {
            shadows: light.shadows,
            lamp_size: light.lamp_size.unwrap_or_default(),
            occlusion: light.ambient_occlusion.is_some(),
            material: Material::of(light).name().to_owned(),
            floor: match light.floor {
                None => "",
                Some(FloorKind::Plain) => "plain",
                Some(FloorKind::Tiles) => "tiles",
            }
            .to_owned(),
            exposure: light.exposure.unwrap_or_default(),
            samples: light.samples.unwrap_or(Look::SAMPLES),
        }
    }

    /// What is asked of the library: no exposure and no samples where there is nothing to gather.
    fn options(&self) -> LightOptions {
        let mut light = LightOptions {
            shadows: self.shadows,
            lamp_size: (self.shadows && self.lamp_size > 0.0).then_some(self.lamp_size),
            ambient_occlusion: self.occlusion.then_some(2),
            floor: match self.floor.as_str() {
                "plain" => Some(FloorKind::Plain),
                "tiles" => Some(FloorKind::Tiles),
                _ => None,
            },
            ..LightOptions::default()
        };
        if let Some(material) = Material::ALL.into_iter().find(|it| it.name() == self.material) {
            material.put_into(&mut light);
        }
        if light.is_asked() {
            light.exposure = (self.exposure != 0.0).then_some(self.exposure);
            light.samples = Some(self.samples.max(1));
        }
        light
    }
}
