//! Ray traced light.

use eframe::egui::{Checkbox, ComboBox, Slider, Ui};
use metaball::{FloorKind, LightOptions};

use crate::{Look, Material, Viewer};

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer) {
    let old = &viewer.look().light;
    let mut light = old.clone();
    ui.weak("Gathered while the camera rests.");
    shadows(ui, &mut light);
    occlusion(ui, &mut light);
    surface(ui, &mut light);
    floor(ui, &mut light);
    let is_lit = LightOptions { samples: None, exposure: None, ..light.clone() }.is_asked();
    if is_lit {
        let mut exposure = light.exposure.unwrap_or_default();
        if ui.add(Slider::new(&mut exposure, -3.0..=3.0).text("Exposure")).changed() {
            light.exposure = (exposure != 0.0).then_some(exposure);
        }
        let mut samples = light.samples.unwrap_or(Look::SAMPLES);
        ui.add(Slider::new(&mut samples, 1..=1024).logarithmic(true).text("Samples"));
        light.samples = Some(samples);
    } else {
        (light.samples, light.exposure) = (None, None);
    }
    if light != *old {
        viewer.set_look(Look { light, ..viewer.look().clone() });
    }
}

fn shadows(ui: &mut Ui, light: &mut LightOptions) {
    // A clear fluid casts none.
    let is_free = light.refraction.is_none();
    ui.add_enabled(is_free, Checkbox::new(&mut light.shadows, "Shadows"));
    if light.shadows {
        let mut size = light.lamp_size.unwrap_or_default();
        ui.add(Slider::new(&mut size, 0.0..=45.0).suffix("°").text("Lamps' width"));
        light.lamp_size = (size > 0.0).then_some(size);
    } else {
        light.lamp_size = None;
    }
}

fn occlusion(ui: &mut Ui, light: &mut LightOptions) {
    let is_free = light.refraction.is_none();
    let mut occludes = light.ambient_occlusion.is_some();
    ui.add_enabled(is_free, Checkbox::new(&mut occludes, "Ambient occlusion"));
    light.ambient_occlusion = occludes.then(|| light.ambient_occlusion.unwrap_or(2));
    if !occludes {
        light.occlusion_reach = None;
    }
}

fn surface(ui: &mut Ui, light: &mut LightOptions) {
    let old = Material::of(light);
    let mut material = old;
    ComboBox::from_label("Material").selected_text(old.name()).show_ui(ui, |ui| {
        for kind in Material::ALL {
            ui.selectable_value(&mut material, kind, kind.name());
        }
    });
    if material != old {
        material.put_into(light);
    }
    match material {
        Material::Matt => {}
        Material::Mirror => {
            let share = light.reflectivity.get_or_insert(0.3);
            ui.add(Slider::new(share, 0.0..=1.0).text("Reflectivity"));
        }
        Material::SeeThrough => {
            let opacity = light.opacity.get_or_insert(0.4);
            ui.add(Slider::new(opacity, 0.0..=1.0).text("Opacity"));
        }
        Material::Fluid => {
            let index = light.refraction.get_or_insert(1.33);
            ui.add(Slider::new(index, 1.0..=2.5).text("Refraction"));
        }
    }
}

fn floor(ui: &mut Ui, light: &mut LightOptions) {
    let kinds = [
        (None, "no floor"),
        (Some(FloorKind::Plain), "plain floor"),
        (Some(FloorKind::Tiles), "tiles"),
    ];
    let named = kinds.into_iter().find(|(kind, _)| *kind == light.floor);
    ComboBox::from_label("Floor").selected_text(named.map_or("", |(_, name)| name)).show_ui(
        ui,
        |ui| {
            for (kind, name) in kinds {
                ui.selectable_value(&mut light.floor, kind, name);
            }
        },
    );
}
