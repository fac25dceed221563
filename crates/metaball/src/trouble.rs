//! Whether it is worth while to try again what has failed.

use std::error::Error as StdError;
use std::io::{self, ErrorKind};

#[cfg(feature = "gpu")]
use metaball_core::gpu::{GpuError, RenderError};

use crate::Error;

/// Whether an error is trouble of the machine: a disk that is full or fails, memory that is not there, an adapter
/// that is missing, lost or too small, a file in use. The same may succeed later, or on another machine. All else is
/// in the input, and fails wherever it is tried.
///
/// Looks at the error and at all its causes. A file that is not there, may not be used or has another content
/// than it should is input.
pub fn is_trouble(error: &(dyn StdError + 'static)) -> bool {
    is_itself_trouble(error) || error.source().is_some_and(is_trouble)
}

fn is_itself_trouble(error: &(dyn StdError + 'static)) -> bool {
    #[cfg(feature = "gpu")]
    if let Some(error) = error.downcast_ref::<RenderError>() {
        return is_trouble_of_adapter(error);
    }
    #[cfg(feature = "gpu")]
    if error.is::<GpuError>() {
        return true;
    }
    match (error.downcast_ref::<Error>(), error.downcast_ref::<io::Error>()) {
        (Some(error), _) => is_trouble_of_drawing(error),
        (_, Some(error)) => is_trouble_of_system(error),
        _ => false,
    }
}

/// What a transparent error holds is none of its causes, so it is looked at here.
fn is_trouble_of_drawing(error: &Error) -> bool {
    match error {
        Error::SpoolInUse { .. } => true,
        #[cfg(feature = "gpu")]
        Error::Adapter(_) | Error::TooLarge { .. } => true,
        #[cfg(feature = "gpu")]
        Error::Render(error) => is_trouble(error),
        Error::Frames(error) => is_trouble(error.as_ref()),
        Error::Frame { source, .. } => is_trouble(source.as_ref()),
        _ => false,
    }
}

#[cfg(feature = "gpu")]
fn is_trouble_of_adapter(error: &RenderError) -> bool {
    let is_lost = matches!(error, RenderError::NoAdapter | RenderError::DeviceLost { .. });
    is_lost || error.is_too_large()
}

/// What decoders refuse is of the kinds `InvalidData`, `UnexpectedEof` and `Other`.
fn is_trouble_of_system(error: &io::Error) -> bool {
    !matches!(
        error.kind(),
        ErrorKind::NotFound
            | ErrorKind::PermissionDenied
            | ErrorKind::AlreadyExists
            | ErrorKind::IsADirectory
            | ErrorKind::NotADirectory
            | ErrorKind::InvalidFilename
            | ErrorKind::InvalidInput
            | ErrorKind::InvalidData
            | ErrorKind::UnexpectedEof
            | ErrorKind::Unsupported
            | ErrorKind::Other
    )
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use particle_files::{LoadError, Overrides, ReadOptions, load};
    use picture_files::PictureFileError;

    use super::*;

    fn written(kind: ErrorKind) -> Error {
        Error::File(PictureFileError::Io {
            verb: "write",
            path: "a.png".into(),
            source: kind.into(),
        })
    }

    #[test]
    fn a_full_disk_is_trouble_and_a_folder_in_the_way_is_not() {
        for kind in [ErrorKind::StorageFull, ErrorKind::TimedOut, ErrorKind::OutOfMemory] {
            assert!(is_trouble(&written(kind)), "{kind}");
        }
        assert!(!is_trouble(&written(ErrorKind::IsADirectory)));
        let in_frame = |source| Error::Frame { number: 7, source: Box::new(source) };
        assert!(is_trouble(&in_frame(written(ErrorKind::StorageFull))));
        assert!(!is_trouble(&in_frame(written(ErrorKind::IsADirectory))));
        let read = |kind: ErrorKind| {
            Error::Frames(LoadError::Read { file: "a.xyz".to_owned(), source: kind.into() }.into())
        };
        assert!(is_trouble(&read(ErrorKind::StaleNetworkFileHandle)));
        assert!(!is_trouble(&read(ErrorKind::NotFound)));
        // An input or output error of the system, which has no kind of its own.
        assert!(is_trouble(&io::Error::from_raw_os_error(5)));
    }

    #[test]
    fn a_broken_file_is_input() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = |path: &Path| {
            load(path, &ReadOptions::default(), &Overrides::default()).expect_err("broken")
        };
        let packed = folder.path().join("a.xyz.zst");
        fs::write(&packed, [0x28, 0xb5, 0x2f, 0xfd, 0xff, 0xff]).expect("written");
        for path in [packed, folder.path().join("none.xyz")] {
            let error = error(&path);
            assert!(!is_trouble(&error), "{error}");
        }
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn what_another_adapter_draws_is_trouble() {
        let of = |error| is_trouble(&Error::Render(error));
        assert!(of(RenderError::OutOfMemory { text: String::new() }));
        assert!(of(RenderError::NoAdapter));
        assert!(!of(RenderError::Unsupported { method: "illes", reason: String::new() }));
    }
}
