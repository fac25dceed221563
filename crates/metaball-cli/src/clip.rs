//! What is cut away: its options.

use clap::Args;
use glam::{DVec3, Vec3};
use metaball::{Clip, ClipError};

use crate::values::numbers;

#[derive(Debug, Args)]
#[command(next_help_heading = "Clipping (filled faces; the certified tree on the CPU)")]
pub(crate) struct ClipArgs {
    /// Keep the side of a plane where X·x + Y·y + Z·z is at most D; may be repeated: what all of them
    /// keep is kept.
    #[arg(long, value_name = "X,Y,Z,D", value_parser = plane, allow_hyphen_values = true)]
    clip: Vec<Plane>,
    /// Keep what is in a box between two corners, the least one first.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = corners, allow_hyphen_values = true)]
    clip_box: Option<Corners>,
}

/// An outward normal and an offset.
#[derive(Debug, Clone, Copy)]
struct Plane(Vec3, f64);

/// The least and the greatest corner of a box.
#[derive(Debug, Clone, Copy)]
struct Corners(DVec3, DVec3);

impl ClipArgs {
    pub(crate) fn clip(&self) -> Result<Clip, ClipError> {
        let clip = self
            .clip
            .iter()
            .copied()
            .try_fold(Clip::default(), |clip, Plane(normal, offset)| {
                clip.and_plane(normal, offset)
            })?;
        match &self.clip_box {
            Some(Corners(least, greatest)) => Vec3::AXES.iter().try_fold(clip, |clip, axis| {
                let offset = |corner: &DVec3| corner.dot(axis.as_dvec3());
                clip.and_plane(*axis, offset(greatest))?.and_plane(-*axis, -offset(least))
            }),
            None => Ok(clip),
        }
    }
}

fn plane(text: &str) -> Result<Plane, String> {
    let [x, y, z, offset] = numbers(text).ok_or("needed four numbers such as 1,0,0,0.5")?;
    let normal = DVec3::new(x, y, z).as_vec3();
    let legal = Clip::default().and_plane(normal, offset);
    legal.map(|_| Plane(normal, offset)).map_err(|error| error.to_string())
}

fn corners(text: &str) -> Result<Corners, String> {
    let needed = "needed six numbers, the least corner first, such as 0,0,0,1,1,0.5";
    let [a, b, c, x, y, z] = numbers(text).ok_or(needed)?;
    let (least, greatest) = (DVec3::new(a, b, c), DVec3::new(x, y, z));
    if least.cmple(greatest).all() { Ok(Corners(least, greatest)) } else { Err(needed.to_owned()) }
}

#[cfg(test)]
mod tests {
    use metaball::Aabb;

    use super::*;
    use crate::{Command, parse};

    #[test]
    fn planes_and_a_box_reach_the_library() {
        let line = "metaball render molecule --clip 1,0,0,0.5 --clip -1,0.5,0,-2 \
                    --clip-box -1,-2,-3,4,5,6";
        let Ok(Command::Render(render)) = parse(line) else { panic!("a legal command line") };
        let corners = Aabb { min: Vec3::new(-1.0, -2.0, -3.0), max: Vec3::new(4.0, 5.0, 6.0) };
        let wanted = Clip::default()
            .and_plane(Vec3::X, 0.5)
            .and_then(|clip| clip.and_plane(Vec3::new(-1.0, 0.5, 0.0), -2.0))
            .and_then(|clip| clip.and_box(&corners));
        assert_eq!(render.clip(), wanted);
        for wrong in ["--clip 1,0,0", "--clip 0,0,0,1", "--clip-box 1,1,1,0,0,0", "--clip x"] {
            assert!(parse(&format!("metaball render molecule {wrong}")).is_err(), "{wrong}");
        }
    }
}
