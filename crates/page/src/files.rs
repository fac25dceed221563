//! The files that were given to the page.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use metaball::{BoxError, Overrides, ReadOptions, load_bytes};
use viewer::{Content, Opener, Subject};

/// Files by name, since a page has no folders.
#[derive(Debug, Default)]
pub(crate) struct Files(Mutex<HashMap<String, Arc<[u8]>>>);

impl Files {
    /// Takes a file, and keeps of the others only the one that is shown.
    pub(crate) fn take(&self, name: &str, bytes: Vec<u8>, shown: Option<&str>) {
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        files.retain(|kept, _| Some(kept.as_str()) == shown);
        files.insert(name.to_owned(), bytes.into());
    }

    fn bytes(&self, name: &str) -> Option<Arc<[u8]>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(name).cloned()
    }
}

impl Opener for Files {
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError> {
        let bytes = self.bytes(spec).ok_or_else(|| format!("{spec}: needed a file, found none"))?;
        let loaded = load_bytes(spec, &bytes, reading, &Overrides::default())?;
        Ok(Subject {
            spec: spec.to_owned(),
            name: loaded.name,
            camera: loaded.camera,
            notes: Some(loaded.notes),
            legend: loaded.legend,
            inputs: vec![PathBuf::from(spec)],
            reading: reading.clone(),
            content: Content::Still(loaded.scene),
        })
    }
}
