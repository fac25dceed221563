"""Particles of arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import metaball
from metaball import Particles, Surface

CENTERS = np.random.default_rng(3).random((50, 3))


def hits_of(particles: Particles) -> npt.NDArray[np.float32]:
    return Surface(particles).hits(size=(40, 30)).t


@pytest.mark.parametrize("dtype", [np.float32, np.float64, ">f4", ">f8", np.int64])
def test_any_numbers_are_taken(dtype: str) -> None:
    centers = (100 * CENTERS).astype(np.int64)
    expected = hits_of(Particles(centers.astype(np.float64), support_radius=20.0))
    assert np.isfinite(expected).sum() > 100
    assert np.array_equal(hits_of(Particles(centers.astype(dtype), support_radius=20)), expected)


def test_strides_are_followed() -> None:
    wide = np.zeros((100, 6), dtype=np.float32)
    strided = wide[::2, ::2]
    strided[:] = CENTERS
    reversed_twice = np.asfortranarray(CENTERS[::-1].astype(np.float32))[::-1]
    expected = hits_of(Particles(CENTERS.astype(np.float32), support_radius=0.3))
    for centers in (strided, reversed_twice):
        particles = Particles(centers, support_radius=0.3)
        assert particles.centers is centers, "not copied"
        assert np.array_equal(hits_of(particles), expected)
    assert not np.array_equal(hits_of(Particles(strided[::-1] + 0.01, support_radius=0.3)), expected)


def test_radii_are_what_shows_or_what_ends() -> None:
    # The quartic under T = 1/4 shows a ball at R/√2.
    shown = hits_of(Particles(CENTERS, radius=0.2))
    ends = hits_of(Particles(CENTERS, support_radius=0.2 * np.sqrt(2)))
    hit = np.isfinite(shown)
    assert np.array_equal(hit, np.isfinite(ends)) and hit.sum() > 100
    np.testing.assert_allclose(shown[hit], ends[hit], rtol=1e-5)
    each = hits_of(Particles(CENTERS, radius=np.full(50, 0.2)))
    np.testing.assert_allclose(each[hit], shown[hit], rtol=1e-5)


def test_without_a_radius_the_spacing_decides() -> None:
    lattice = np.stack(np.meshgrid(*3 * [np.arange(4.0)]), axis=-1).reshape(-1, 3)
    bounds = Surface(Particles(3 * lattice)).bounds
    assert bounds is not None
    np.testing.assert_allclose(bounds, np.array([3 * [-6.0], 3 * [15.0]]), rtol=1e-6)


def test_far_from_the_origin_nothing_moves() -> None:
    far = np.array([5e6, -3e6, 1e7])
    near, moved = (
        Surface(Particles(CENTERS + shift, support_radius=0.3)) for shift in (np.zeros(3), far)
    )
    eye, direction = np.array([0.5, 0.5, -3.0]), np.array([0.0, 0.0, 1.0])
    expected = near.trace(eye, direction)
    found = moved.trace(far + eye, direction)
    assert expected.verdicts == metaball.Verdict.HIT
    # Coordinates of 1e7 are rounded to 2e-9 in float64, those of the scene to 3e-8.
    np.testing.assert_allclose(found.t, expected.t, rtol=1e-6)
    at = np.array([0.5, 0.5, float(found.t) - 3.0])
    np.testing.assert_allclose(found.points(far + eye, direction) - far, at, atol=1e-6)


def test_colours_are_shares_or_bytes() -> None:
    shares = np.array([0.2, 0.4, 1.0])
    as_bytes = np.array([51, 102, 255], dtype=np.uint8)
    for color in (shares, as_bytes, np.tile(shares, (50, 1))):
        particles = Particles(CENTERS, color=color)
        assert particles.color is not None
        assert np.array_equal(particles.color, np.tile(as_bytes, (50, 1)))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"centers": np.zeros((4, 2))}, r"centers: needed an array of shape \(..., 3\)"),
        ({"centers": [["a", "b", "c"]]}, "centers: needed numbers"),
        ({"radius": 1.0, "support_radius": 1.0}, "needed a radius or a support radius, found both"),
        ({"radius": np.ones(3)}, r"radius: needed a number or shape \(50,\), found \(3,\)"),
        ({"strength": np.ones((50, 1))}, "strength: needed a number"),
        ({"color": np.ones((50, 4))}, "color: needed shape"),
        ({"color": [2.0, 0.0, 0.0]}, "color: needed numbers from 0 to 1"),
    ],
)
def test_arrays_that_do_not_fit_are_named(
    arguments: dict[str, npt.ArrayLike], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        Particles(**{"centers": CENTERS, **arguments})


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"support_radius": -1.0}, "ball 0: needed a support radius"),
        ({"strength": np.where(np.arange(50) == 7, 0.0, 1.0)}, "ball 7: needed a finite strength"),
        ({"centers": np.where(np.arange(50)[:, None] == 9, np.nan, CENTERS)}, "ball 9: needed a finite"),
        ({"radius": 1.0, "strength": 0.2}, "needed a strength above the threshold 0.25"),
    ],
)
def test_particles_that_make_no_surface_are_named(
    arguments: dict[str, npt.ArrayLike], words: str
) -> None:
    particles = Particles(**{"centers": CENTERS, **arguments})
    with pytest.raises(ValueError, match=words):
        Surface(particles)


def test_negative_balls_take_away() -> None:
    centers = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    rays = ([0.0, 0.0, 5.0], [0.0, 0.0, -1.0])
    whole = Surface(Particles(centers[:1], support_radius=2.0))
    carved = Surface(Particles(centers, support_radius=[2.0, 1.0], strength=[1.0, -1.0]))
    assert carved.trace(*rays).t > whole.trace(*rays).t + 0.1
    assert carved.field([0.0, 0.0, 1.0]) == pytest.approx(0.75**2 - 1.0)


def test_kernels_are_the_librarys() -> None:
    particles = Particles(CENTERS, support_radius=0.3)
    assert Surface(particles, kernel="quartic").kernel == "power-2"
    assert Surface(particles, kernel="wyvill").kernel == "wyvill"
    assert Surface(particles, kernel="cubic-spline").kernel == "cubic-spline"
    with pytest.raises(ValueError, match='kernel: needed power-1 to power-8 .* found "gauss"'):
        Surface(particles, kernel="gauss")
    with pytest.raises(ValueError, match="threshold: needed a finite number above 0"):
        Surface(particles, threshold=0.0)


def test_none_is_legal() -> None:
    empty = Surface(Particles(np.zeros((0, 3))))
    assert len(empty) == 0 and empty.bounds is None
    assert not empty.hits(size=(4, 3)).is_hit.any()
