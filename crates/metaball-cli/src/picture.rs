//! Pictures and colours: their names on the command line.

#[cfg(feature = "viewer")]
use metaball_core::shade::CpuPicture;
use metaball_core::{Color, Picture, WorkKind};

use crate::values::vector;

/// The picture of that name: `phong`, `normal`, `depth`, `color`, `spheres`, or `work:` and a counter
/// such as `work:leaf-tests`.
///
/// # Errors
/// When there is none; lists them all.
pub(crate) fn picture_named(name: &str) -> Result<Picture, String> {
    names().find_map(|(known, picture)| (known == name).then_some(picture)).ok_or_else(|| {
        let known: Vec<_> = names().map(|(known, _)| known).collect();
        format!("needed one of {}", known.join(", "))
    })
}

/// The same, of those that the CPU draws.
///
/// # Errors
/// When it is another; says which there are.
#[cfg(feature = "viewer")]
pub(crate) fn picture_on_cpu(name: &str) -> Result<Picture, String> {
    let picture = picture_named(name)?;
    match CpuPicture::of(picture) {
        Some(_) => Ok(picture),
        None => Err(CpuPicture::CHOICE.to_owned()),
    }
}

/// The colour of three sRGB-encoded channels from 0 to 1, with commas between.
///
/// # Errors
/// When they are no colour.
pub(crate) fn color_of(channels: &str) -> Result<Color, String> {
    let found = vector(channels).ok();
    let found = found.filter(|of| of.min_element() >= 0.0 && of.max_element() <= 1.0);
    let encoded = 255.0 * found.ok_or("needed three numbers from 0 to 1, such as 0.2,0.5,0.9")?;
    let [red, green, blue] = encoded.round().to_array().map(|channel| channel as u8);
    Ok(Color::srgb(red, green, blue))
}

fn names() -> impl Iterator<Item = (String, Picture)> {
    let plain = [
        ("phong", Picture::Phong),
        ("normal", Picture::Normal),
        ("depth", Picture::Depth),
        ("color", Picture::Color),
        ("spheres", Picture::Spheres),
    ];
    let work = WorkKind::ALL
        .map(|kind| (format!("work:{}", kind.to_string().replace(' ', "-")), Picture::Work(kind)));
    plain.map(|(name, picture)| (name.to_owned(), picture)).into_iter().chain(work)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_have_names() {
        assert_eq!(picture_named("phong"), Ok(Picture::Phong));
        assert_eq!(picture_named("work:leaf-tests"), Ok(Picture::Work(WorkKind::LeafTests)));
        let error = picture_named("work").expect_err("no counter named");
        assert!(error.contains("spheres, work:nodes"), "{error}");
    }

    #[test]
    fn colors_have_three_channels() {
        assert_eq!(color_of("0,0.5, 1"), Ok(Color::srgb(0, 128, 255)));
        for wrong in ["0,0.5", "0,0,1.1", "-0.1,0,0", "red"] {
            assert!(color_of(wrong).is_err(), "{wrong}");
        }
    }
}
