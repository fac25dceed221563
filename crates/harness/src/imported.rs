//! Hits that another program found, scored as a method's are: `docs/hits-format.md`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use metaball_core::Scene;
use picture_files::{HitImage, PictureFileError, read_hits};

use crate::record::{Adapter, Record, Scored, Status};
use crate::reference::Reference;
use crate::score::{Accuracy, score};

/// How far off hits are; without normals there are no errors of normals.
///
/// # Errors
/// When the reference is of a picture of another size.
pub fn accuracy_of(image: &HitImage, reference: &Reference) -> anyhow::Result<Accuracy> {
    let accuracy = score(reference, &image.hits)?;
    let normal_degrees = accuracy.normal_degrees.filter(|_| image.has_normals);
    Ok(Accuracy { normal_degrees, ..accuracy })
}

/// A picture by another program.
#[derive(Debug, Clone)]
pub struct ImportedHits {
    /// What the program is called in tables.
    pub name: String,
    /// Where its hits are from.
    pub file: PathBuf,
    /// Its hits.
    pub image: HitImage,
}

impl ImportedHits {
    /// Reads a file of hits.
    ///
    /// # Errors
    /// When it cannot be read or holds something else.
    pub fn read(name: &str, file: &Path) -> Result<Self, PictureFileError> {
        Ok(Self { name: name.to_owned(), file: file.to_owned(), image: read_hits(file)? })
    }

    /// Their record, which has no times. `adapter` is what drew the others.
    ///
    /// # Errors
    /// When the reference is of a picture of another size.
    pub fn record(
        &self,
        (name, scene): (&str, &Scene),
        reference: &Reference,
        adapter: Adapter,
    ) -> anyhow::Result<Record> {
        let accuracy = accuracy_of(&self.image, reference)?;
        Ok(Record {
            scene: name.to_owned(),
            balls: scene.len(),
            kernel: scene.kernel().to_string(),
            threshold: scene.threshold(),
            method: self.name.clone(),
            options: BTreeMap::new(),
            width: self.image.width,
            height: self.image.height,
            adapter,
            status: Status::Scored,
            reason: None,
            measured: None,
            scored: Some(Scored { file: self.file.display().to_string(), accuracy }),
        })
    }
}

#[cfg(test)]
mod tests {
    use bench_scenes::{Overrides, load};
    use metaball_core::reference::Oracle;
    use metaball_core::{Hit, Verdict, View};

    use super::*;

    /// The oracle's own hits have no error, and one that is moved is found.
    #[test]
    fn another_programs_hits_are_scored() {
        let bench = load("two-merging", &Overrides::default()).expect("known");
        let view = View::new(bench.camera, 32, 24).expect("a view");
        let truths = Oracle::new(&bench.scene).first_hits(&view.rays());
        let reference = Reference::of_every_pixel((32, 24), truths);
        let mut image =
            HitImage { width: 32, height: 24, hits: reference.hits(), has_normals: false };
        let scored = |image: &HitImage| {
            let (name, file) = ("other".to_owned(), PathBuf::from("other.exr"));
            let imported = ImportedHits { name, file, image: image.clone() };
            let record =
                imported.record(("two-merging", &bench.scene), &reference, Adapter::none());
            record.expect("of this size").scored.expect("scored").accuracy
        };
        let accuracy = scored(&image);
        assert!(accuracy.oracle_hits > 50 && accuracy.wrong_verdicts() == 0);
        assert_eq!(accuracy.normal_degrees, None);
        let is_hit = |hit: &&mut Hit| hit.verdict == Verdict::Hit;
        let hit = image.hits.iter_mut().filter(is_hit).nth(20).expect("hits");
        hit.t += 0.2;
        assert_eq!(scored(&image).wrong_front, 1);
    }
}
