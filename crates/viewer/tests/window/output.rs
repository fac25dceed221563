//! Files, and the command that draws them.

use glam::DVec3;
use metaball::{Backend, DrawOptions, draw};
use viewer::Export;

use crate::stage::{Bench, start, until, window_of};

#[test]
fn a_file_is_what_render_writes() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut begin = start("colors-100");
    begin.viewpoint.eye = Some(DVec3::new(0.5, 1.0, 4.0));
    let mut harness = window_of(std::sync::Arc::new(Bench), begin);
    until(&mut harness, |viewer| viewer.painting().is_some());
    let image = folder.path().join("picture.png");
    let export = Export { image: image.clone(), size: (80, 60), exr: true };
    harness.state_mut().viewer_mut().export(export.clone());
    until(&mut harness, |viewer| viewer.exported().is_some());
    let viewer = harness.state().viewer();
    assert_eq!(viewer.exported(), Some(Ok(&*image.display().to_string())));

    let options = DrawOptions {
        size: export.size,
        viewpoint: viewer.viewpoint(),
        backend: Backend::Cpu,
        ..DrawOptions::default()
    };
    let (scene, camera) =
        (viewer.model().expect("built").scene(), &viewer.subject().expect("open").camera);
    let wanted = draw(scene, camera, &options).expect("drawn");
    let [png, exr] = ["wanted.png", "wanted.exr"].map(|name| folder.path().join(name));
    wanted.save_image(&png).expect("written");
    wanted.save_hits(&exr).expect("written");
    let same = |found, wanted| {
        std::fs::read(found).expect("there") == std::fs::read(wanted).expect("there")
    };
    assert!(same(image.clone(), png) && same(image.with_extension("exr"), exr));

    let refused = Export { image: folder.path().join("picture.gif"), ..export };
    harness.state_mut().viewer_mut().export(refused);
    until(&mut harness, |viewer| viewer.exported().is_some());
    let error = harness.state().viewer().exported().expect("tried").expect_err("refused");
    assert!(error.contains("found .gif"), "{error}");
}
