//! The files that an experiment writes: none of them is one that it reads.

use std::path::{Path, PathBuf};

use picture_files::{PictureFileError, RunFile, ensure_writable, refuse_overlap};

/// The paths of files of these names in a folder. They can be written, and are none of the files behind the
/// scenes that a user named, and none of these files of hits.
///
/// # Errors
/// When one of them is, or cannot be written: before anything is measured.
pub(crate) fn output_files<const N: usize>(
    folder: &Path,
    names: [&str; N],
    scenes: &[String],
    hits: &[PathBuf],
) -> Result<[PathBuf; N], PictureFileError> {
    let files = names.map(|name| folder.join(name));
    let outputs: Vec<RunFile> = files.iter().map(|file| ("results", file.clone())).collect();
    let scenes = scenes.iter().flat_map(|spec| bench_scenes::inputs(spec));
    let hits = hits.iter().map(|file| ("file of hits", file.clone()));
    let inputs: Vec<RunFile> = scenes.map(|file| ("scene", file)).chain(hits).collect();
    refuse_overlap(&outputs, &inputs)?;
    for file in &files {
        ensure_writable(file)?;
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn results_replace_no_input() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("records.csv"), "x,y,z,radius\n0,0,0,1\n").expect("written");
        let names = ["index.html", "records.csv"];
        let files = |scenes: &[PathBuf], hits: &[PathBuf]| {
            let scenes: Vec<_> = scenes.iter().map(|path| path.display().to_string()).collect();
            let files = output_files(folder.path(), names, &scenes, hits);
            files.map_err(|error| error.to_string())
        };
        assert_eq!(files(&[at("other.csv")], &[]), Ok(names.map(at)));
        for (scenes, hits, what) in [
            (vec![at("records.csv")], vec![], "found the scene"),
            (vec!["molecule".into()], vec![at("records.csv")], "found the file of hits"),
        ] {
            let error = files(&scenes, &hits).expect_err("refused");
            assert!(error.contains(what), "{error}");
        }
        assert!(output_files(&at("records.csv"), names, &[], &[]).is_err(), "a file is no folder");
    }
}
