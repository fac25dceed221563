//! The page in a browser without a display: files are given to it, and what its canvas shows is held against
//! the library's drawing, byte for byte. `cargo xtask web --test` makes the page and runs this.

mod driver;
mod http;
mod server;
mod stage;

use std::fs;

use metaball::{
    Backend, DrawOptions, LightOptions, Loaded, Overrides, ReadOptions, Viewpoint, draw, load,
};

use crate::stage::{Stage, Taken};

const MOLECULE: &str = "../../bench-scenes/data/md_1u19.pdb.gz";
const WATER: &str = "../particle-files/examples/water.xyz";

/// What `render` draws, red, green, blue and opacity of each pixel.
fn rendered(loaded: &Loaded, taken: &Taken, light: LightOptions) -> Vec<u8> {
    let options = DrawOptions {
        size: taken.size,
        viewpoint: taken.viewpoint,
        light,
        backend: Backend::Cpu,
        ..DrawOptions::default()
    };
    let drawing = draw(&loaded.scene, &loaded.camera, &options).expect("drawn");
    assert!(drawing.hit_count() > 1000, "something is to be seen");
    drawing.image.rgba.clone()
}

fn read(path: &str) -> Loaded {
    load(path, &ReadOptions::default(), &Overrides::default()).expect("a file")
}

/// Pixels that differ.
fn differences(one: &[u8], other: &[u8]) -> usize {
    assert_eq!(one.len(), other.len(), "of one size");
    one.chunks(4).zip(other.chunks(4)).filter(|(one, other)| one != other).count()
}

#[test]
#[ignore = "needs a page (PAGE_FOLDER) and chromedriver: cargo xtask web --test"]
fn the_canvas_is_what_render_draws() {
    let stage = Stage::open();
    let none = LightOptions::default();

    let molecule = read(MOLECULE);
    let first = stage.rested("molecule.pdb.gz", "sharp");
    let wanted = rendered(&molecule, &first, none.clone());
    assert_eq!(differences(&first.rgba, &wanted), 0, "the molecule at first");

    // The canary: a comparison that sees one bit of one pixel, and another place of the eye.
    let mut broken = first.rgba.clone();
    broken[4 * 1234] ^= 1;
    assert_eq!(differences(&broken, &wanted), 1);

    stage.drag((0.5, 0.5), (0.62, 0.41));
    let turned = stage.rested("molecule.pdb.gz", "sharp");
    assert_ne!(turned.viewpoint, Viewpoint::default());
    assert!(differences(&turned.rgba, &wanted) > 10_000, "it has turned");
    let wanted = rendered(&molecule, &turned, none.clone());
    assert_eq!(differences(&turned.rgba, &wanted), 0, "turned");

    stage.click((0.5, 0.5));
    stage.until("a point is picked", "document.querySelectorAll('#points meter').length > 0");

    stage.give(WATER);
    let water = stage.rested("water.xyz", "sharp");
    let wanted = rendered(&read(WATER), &water, none);
    assert_eq!(differences(&water.rgba, &wanted), 0, "a file that was given");

    let table = "x,y,z,radius\n0,0,0,1\n1.2,0.3,0,0.8\n";
    stage.drop("two.csv", table);
    let dropped = stage.rested("two.csv", "sharp");
    let path = std::env::temp_dir().join(format!("page-{}-two.csv", std::process::id()));
    fs::write(&path, table).expect("written");
    let two = read(path.to_str().expect("a path of Unicode"));
    fs::remove_file(&path).expect("removed");
    let wanted = rendered(&two, &dropped, LightOptions::default());
    assert_eq!(differences(&dropped.rgba, &wanted), 0, "a file that was dropped");

    stage.run(
        "document.querySelector('#samples').value = 2; document.querySelector('#shadows').click()",
    );
    let lit = stage.rested_at("two.csv", "lit", "light 2 of 2");
    let light = LightOptions { shadows: true, samples: Some(2), ..LightOptions::default() };
    let wanted = rendered(&two, &lit, light);
    assert_eq!(differences(&lit.rgba, &wanted), 0, "in light");

    stage.drop("broken.csv", "x,y,z,radius\n0,0,0,four\n");
    stage.until(
        "it says what is wrong",
        "document.querySelector('#notice').textContent.includes('line 2, column 4 (radius)')",
    );

    let asked = stage.requests();
    assert!(asked.iter().any(|request| request.starts_with("GET /page_bg.wasm ")));
    let mut others = asked.iter().filter(|request| !request.starts_with("GET "));
    assert_eq!(others.next(), None, "nothing is sent");
}
