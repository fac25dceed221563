"""Rays, and the field at points."""

from __future__ import annotations

import numpy as np
import pytest

import metaball
from metaball import Surface, Verdict


def test_a_lone_ball_is_hit_where_it_shows(lone: Surface) -> None:
    t, normals, verdicts = lone.trace([0, 0, -5], [[0, 0, 1], [0, 0, 2], [0, 1, 0]])
    np.testing.assert_allclose(t, [5 - np.sqrt(2), 5 - np.sqrt(2), np.inf], rtol=1e-7)
    np.testing.assert_array_equal(normals, [[0, 0, -1], [0, 0, -1], [0, 0, 0]])
    assert verdicts.tolist() == [Verdict.HIT, Verdict.HIT, Verdict.MISS]


def test_what_rays_meet_has_their_shape(lone: Surface) -> None:
    grid = np.stack(np.meshgrid([0.0, 0.5, 9.0], [0.0, 0.1], [-5.0], indexing="ij"), axis=-1)
    hits = lone.trace(grid, [0, 0, 1])
    assert hits.shape == (3, 2, 1) and hits.normals.shape == (3, 2, 1, 3)
    assert hits.is_hit.tolist() == [[[True], [True]], [[True], [True]], [[False], [False]]]
    single = lone.trace(grid[1, 1, 0], [0, 0, 1])
    assert single.shape == () and single.t == hits.t[1, 1, 0]
    assert lone.trace(np.zeros((0, 3)), [0, 0, 1]).shape == (0,)


def test_ends_of_rays_count(lone: Surface) -> None:
    surface_at = 5 - np.sqrt(2)
    eye, ahead = [0, 0, -5], [0, 0, 1]
    ends = np.array([surface_at - 0.01, surface_at + 0.01])
    assert lone.any_hit(eye, ahead, t_max=ends).tolist() == [Verdict.MISS, Verdict.HIT]
    inside = lone.trace(eye, ahead, t_min=5.0)
    assert inside.verdicts == Verdict.INSIDE and inside.t == 5.0
    assert lone.any_hit(eye, ahead, t_min=5.0) == Verdict.INSIDE


def test_rays_from_inside_leave(lone: Surface) -> None:
    exits = lone.exit([0, 0, 0], [[0, 0, 1], [1, 1, 1]])
    np.testing.assert_allclose(exits.t, np.sqrt(2), rtol=1e-6)
    np.testing.assert_allclose(exits.normals[1], 1 / np.sqrt(3), rtol=1e-6)
    assert lone.exit([0, 0, -5], [0, 0, 1]).verdicts == Verdict.INSIDE


def test_field_and_gradient_are_the_kernels(lone: Surface) -> None:
    at = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.0, 1.2, 0.0], [0.0, 0.0, 3.0]]])
    v = np.maximum(1 - (at**2).sum(axis=-1) / 4, 0)
    np.testing.assert_allclose(lone.field(at), v**2, rtol=1e-14)
    np.testing.assert_allclose(lone.gradient(at), -v[..., np.newaxis] * at, rtol=1e-14)


def test_hits_lie_on_the_surface(surface: Surface) -> None:
    eye, directions = surface.rays(size=(80, 60))
    hits = surface.trace(eye, directions)
    assert 500 < hits.is_hit.sum() < hits.is_hit.size
    at = hits.points(eye, directions)[hits.is_hit]
    outward = -surface.gradient(at)
    steepness = np.linalg.norm(outward, axis=-1)
    # Distances are rounded to float32, some 3e-7 here.
    assert np.all(np.abs(surface.field(at) - 0.25) <= 1e-6 * (1 + steepness))
    np.testing.assert_allclose(outward / steepness[:, None], hits.normals[hits.is_hit], atol=1e-4)
    assert np.isnan(hits.points(eye, directions)[~hits.is_hit]).all()
    # The canary: a little further it is no longer the surface.
    assert not np.any(np.abs(surface.field(at + 0.01 * hits.normals[hits.is_hit]) - 0.25) <= 1e-6)


def test_many_rays_are_answered_as_few_are(surface: Surface) -> None:
    """More than are traced together."""
    eye, directions = surface.rays(size=(500, 400))
    whole = surface.trace(eye, directions)
    assert np.array_equal(whole.t, surface.hits(size=(500, 400)).t)
    rows = surface.trace(eye, directions[390:])
    assert np.array_equal(rows.t, whole.t[390:]) and np.array_equal(rows.normals, whole.normals[390:])
    starts = np.broadcast_to(eye, directions.shape)
    assert np.array_equal(surface.trace(starts, directions.astype(np.float64)).t, whole.t)


@pytest.mark.parametrize(
    ("origins", "directions", "words"),
    [
        ([0, 0, 0], [[0, 0, 1], [0, 0, 0]], "directions, ray 1: needed a finite vector"),
        ([[0, 0, 0], [np.nan, 0, 0]], [0, 0, 1], "origins, ray 1: needed a finite point"),
        ([0, 0], [0, 0, 1], "origins: needed an array of shape"),
        (np.zeros((2, 3)), np.ones((3, 3)), "rays: needed shapes that fit one another"),
    ],
)
def test_rays_that_are_none_are_named(
    surface: Surface, origins: list[float], directions: list[float], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        surface.trace(origins, directions)


def test_verdicts_have_names() -> None:
    assert [verdict.name for verdict in metaball.Verdict] == ["MISS", "HIT", "INSIDE", "UNDECIDED"]
