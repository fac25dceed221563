"""Pictures, and what is written of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metaball import Camera, Image, Surface

SIZE = (80, 60)


def test_a_picture_shows_itself(surface: Surface) -> None:
    image = surface.render(size=SIZE)
    assert image.numpy().shape == (60, 80, 4) and image.size == SIZE
    assert image._repr_png_().startswith(b"\x89PNG") and image.light is None
    assert np.array_equal(np.asarray(image), image.pixels)
    assert np.array_equal(image.hits.t, surface.hits(size=SIZE).t)
    background = image.pixels[0, 0]
    seen = np.any(image.pixels[30] != background, axis=-1)
    assert seen[image.hits.is_hit[30]].all(), "the surface is not the background"
    assert "80 × 60 pixels" in repr(image)


def test_light_is_asked_for_by_the_command_lines_names(surface: Surface) -> None:
    plain = surface.render(size=SIZE)
    shaded = surface.render(size=SIZE, shadows=True, lamp=(1, 1, 0), samples=2)
    assert shaded.light is not None and shaded.light.shape == (60, 80, 3)
    assert not np.array_equal(shaded.pixels, plain.pixels)
    two = surface.render(size=SIZE, shadows=True, lamp=[(1, 1, 0), (-1, 1, 0)], samples=2)
    assert not np.array_equal(shaded.pixels, two.pixels)
    again = surface.render(size=SIZE, shadows=True, lamp=(1, 1, 0), samples=2)
    assert np.array_equal(shaded.pixels, again.pixels), "the same bytes"


def test_every_option_of_light_reaches_the_library(surface: Surface) -> None:
    small = (40, 30)
    pictures = [surface.render(size=small).pixels, surface.render(size=small, samples=1).pixels]
    for options in (
        {"shadows": True},
        {"shadows": True, "lamp_size": 20.0},
        {"ambient_occlusion": 4},
        {"ambient_occlusion": 4, "occlusion_reach": 0.1},
        {"reflections": 1},
        {"reflections": 1, "reflectivity": 0.9},
        {"refraction": 1.33, "samples": 1},
        {"refraction": 1.33, "samples": 1, "absorption": (9.0, 0.0, 0.0)},
        {"refraction": 1.33, "samples": 1, "bounces": 1},
        {"opacity": 0.5},
        {"floor": "plain"},
        {"floor": "tiles"},
        {"cel": 2},
        {"depth_cue": 3.0},
        {"samples": 2},
        {"samples": 2, "seed": 1},
        {"exposure": 1.0},
    ):
        picture = surface.render(size=small, **options).pixels
        assert all(not np.array_equal(picture, other) for other in pictures), options
        pictures.append(picture)


def test_what_a_picture_shows_is_chosen(surface: Surface) -> None:
    kinds = [surface.render(size=SIZE, picture=name).pixels for name in ("normal", "depth", "color")]
    assert not np.array_equal(kinds[0], kinds[1]) and not np.array_equal(kinds[1], kinds[2])


def test_cameras_move(surface: Surface) -> None:
    own = surface.camera
    same = surface.hits(Camera(own.eye, own.look_at, own.up, own.fov), SIZE)
    expected = surface.hits(size=SIZE)
    # The camera's axes are made anew, in float32.
    assert (same.is_hit != expected.is_hit).mean() < 0.01
    assert surface.hits(Camera(fov=20.0), SIZE).is_hit.sum() > expected.is_hit.sum()
    away = surface.hits(Camera(eye=(0.5, 0.5, 9.0), look_at=(0.5, 0.5, 10.0)), SIZE)
    assert not away.is_hit.any()


def test_the_solid_is_cut(surface: Surface) -> None:
    whole = surface.render(size=SIZE).hits
    cut = surface.render(size=SIZE, clip=[((0, 0, 1), 0.5)]).hits
    both = whole.is_hit & cut.is_hit
    assert (cut.t[both] > whole.t[both] + 0.1).any() and both.sum() > 100
    boxed = surface.render(size=SIZE, clip_box=((0.4, 0.4, 0.4), (0.6, 0.6, 0.6))).hits
    assert 0 < boxed.is_hit.sum() < cut.is_hit.sum()


def test_files_are_written(surface: Surface, tmp_path: Path) -> None:
    image = surface.render(size=SIZE, shadows=True)
    image.save(tmp_path / "image.png")
    image.save(str(tmp_path / "image.jpg"))
    image.save_light(tmp_path / "light.exr")
    image.hits.save(tmp_path / "hits.npy")
    assert (tmp_path / "image.png").read_bytes() == image.png()
    assert (tmp_path / "image.jpg").read_bytes().startswith(b"\xff\xd8")
    written = np.load(tmp_path / "hits.npy")
    assert np.array_equal(written[..., 0], image.hits.t)
    assert np.array_equal(written[..., 1:], image.hits.normals)
    with pytest.raises(ValueError, match="found .gif"):
        image.save(tmp_path / "image.gif")
    with pytest.raises(OSError):
        image.save("/proc/nowhere/image.png")
    with pytest.raises(ValueError, match="light: needed an option of light"):
        surface.render(size=SIZE).save_light(tmp_path / "none.exr")
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "hits.npy",
        "image.jpg",
        "image.png",
        "light.exr",
    ]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"opacity": 2.0}, "opacity: needed a share from 0 to 1, found 2"),
        ({"floor": "carpet"}, 'floor: needed plain or tiles, found "carpet"'),
        ({"picture": "smell"}, 'picture: needed phong, normal, depth or color, found "smell"'),
        ({"size": (0, 4)}, "image size: needed from 1"),
        ({"camera": Camera(fov=200.0)}, "needed an angle above 0 and below 180"),
        ({"clip": [((0.0, 0.0, 0.0), 1.0)]}, "clip"),
        ({"clip_box": ((1.0, 0.0, 0.0), (0.0, 1.0, 1.0))}, "clip_box: needed the least corner"),
    ],
)
def test_nonsense_is_named(surface: Surface, options: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        surface.render(**options)  # type: ignore[arg-type]


def test_names_that_are_none_are_refused(surface: Surface) -> None:
    with pytest.raises(TypeError, match="shadow: needed an option of light of shadows, lamp"):
        surface.render(size=SIZE, shadow=True)  # type: ignore[call-arg]
    with pytest.raises(FileNotFoundError, match="nowhere.hdr"):
        surface.render(size=SIZE, environment="nowhere.hdr")


def test_images_are_arrays(lone: Surface) -> None:
    image: Image = lone.render(size=(4, 3))
    assert np.asarray(image, dtype=np.float32).dtype == np.float32
    with pytest.raises(ValueError, match="needed a dtype that needs no copy"):
        np.array(image, dtype=np.float32, copy=False)
