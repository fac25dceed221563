//! The programs that ours is held against, as far as they are installed.

use anyhow::Context;
use metaball_core::{Scene, View};

use super::contender::Contender;
use super::embree::{self, Embree, Gather};
use super::mesh::{self, Mesh};
use super::povray::primary::Primary;
use super::povray::{self, Povray};
use super::run::{PlannedScene, THREADS};

/// What was found of them.
#[derive(Debug, Default)]
pub struct Programs {
    /// POV-Ray.
    pub povray: Option<Povray>,
    /// Python with VTK and Mitsuba.
    pub mesh: Option<Mesh>,
    /// Embree, and a compiler.
    pub embree: Option<Embree>,
}

/// A contender by its name in tables, or why there is none.
pub(super) type Named<'a> = (String, anyhow::Result<Box<dyn Contender + 'a>>);

impl Programs {
    /// Looks for all of them.
    ///
    /// # Errors
    /// When one is there and does not work.
    pub fn find() -> anyhow::Result<Self> {
        Ok(Self { povray: Povray::find()?, mesh: Mesh::find()?, embree: Embree::find()? })
    }

    /// For each that is missing, that it is, and how one comes by it.
    pub(super) fn absent(&self) -> Vec<String> {
        let missing = |is_there: bool, who: &str, install: &str| {
            (!is_there).then(|| format!("{who} not installed: such rows are skipped. {install}"))
        };
        let all = [
            missing(self.povray.is_some(), "POV-Ray is", povray::INSTALL),
            missing(self.mesh.is_some(), "VTK and Mitsuba for Python are", &mesh::install()),
            missing(self.embree.is_some(), "Embree 3 or a C++ compiler is", embree::INSTALL),
        ];
        all.into_iter().flatten().collect()
    }

    /// What those call themselves that are there.
    pub(super) fn versions(&self) -> Vec<String> {
        let all = [
            self.povray.as_ref().map(Povray::version),
            self.mesh.as_ref().map(Mesh::versions),
            self.embree.as_ref().map(Embree::version),
        ];
        all.into_iter().flatten().map(str::to_owned).collect()
    }

    /// All contenders for a view of a scene, POV-Ray first.
    pub(super) fn contenders<'a>(
        &self,
        planned: &PlannedScene,
        scene: &'a Scene,
        view: &'a View,
    ) -> Vec<Named<'a>> {
        const ABSENT: &str = "not installed";
        let pair = (scene, view);
        let povray = self.povray.as_ref().context(ABSENT);
        let povray = povray.and_then(|_| Primary::new(scene, view, THREADS)).map(boxed);
        let meshes = planned.cells.iter().map(|&cells| {
            let job = self.mesh.as_ref().context(ABSENT);
            let job = job.and_then(|mesh| mesh.job(pair, THREADS, cells)).map(boxed);
            (format!("VTK mesh of {cells} cells, Mitsuba"), job)
        });
        let gathers = Gather::ALL.into_iter().map(|gather| {
            let job = self.embree.as_ref().context(ABSENT);
            let job = job.and_then(|embree| embree.job(pair, THREADS, gather)).map(boxed);
            (gather.name().to_owned(), job)
        });
        std::iter::once((povray::NAME.to_owned(), povray)).chain(meshes).chain(gathers).collect()
    }
}

fn boxed<'a>(contender: impl Contender + 'a) -> Box<dyn Contender + 'a> {
    Box::new(contender)
}
