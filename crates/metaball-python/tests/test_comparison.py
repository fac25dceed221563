"""Hits held against the exact reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metaball import Finding, Hits, Surface, Verdict

SIZE = (64, 48)


def test_the_truth_is_what_is_traced(surface: Surface) -> None:
    rays = surface.rays(size=SIZE)
    truth, hits = surface.truth(*rays), surface.trace(*rays)
    clear = truth.margins > 1e-5
    assert np.array_equal(truth.verdicts[clear], hits.verdicts[clear])
    hit = clear & hits.is_hit
    assert hit.sum() > 300
    np.testing.assert_allclose(hits.t[hit], truth.t[hit], rtol=1e-6)
    np.testing.assert_allclose(hits.normals[hit], truth.normals[hit], atol=1e-4)


def test_a_right_picture_scores_well(surface: Surface) -> None:
    hits = surface.hits(size=SIZE)
    score = surface.score(hits)
    assert score.rays == 64 * 48 and score.true_hits > 300 and score.wrong == 0
    assert score.t_error_over_radius is not None and score.t_error_over_radius[2] < 1e-4
    assert score.normal_degrees is not None and score.normal_degrees[2] < 0.1


def test_canaries_are_rejected(surface: Surface) -> None:
    hits = surface.hits(size=SIZE)
    t, normals, verdicts = (np.roll(array, 1, axis=1) for array in hits)
    shifted = Hits.of(t, normals, verdicts)
    score = surface.score(shifted)
    assert score.false_negative > 10 and score.false_positive > 10
    behind = surface.score(replace(hits, t=hits.t + np.float32(0.1)))
    assert behind.wrong_front > 300 and behind.false_negative == 0
    flipped = surface.score(replace(hits, normals=-hits.normals))
    assert flipped.normal_degrees is not None and flipped.normal_degrees[0] > 179


def test_each_ray_has_a_finding(surface: Surface) -> None:
    rays = surface.rays(size=SIZE)
    hits = surface.trace(*rays)
    row, column = np.argwhere(hits.is_hit)[100]
    away_row, away_column = np.argwhere(~hits.is_hit)[100]
    t = hits.t.astype(np.float64)
    t[row, column] = np.inf
    t[away_row, away_column] = 3.0
    mine = Hits.of(t)
    found = surface.compare(mine, *rays)
    assert found.findings[row, column] == Finding.FALSE_NEGATIVE
    assert found.findings[away_row, away_column] == Finding.FALSE_POSITIVE
    assert np.argwhere(found.wrong).shape == (2, 2)
    assert np.isnan(found.errors[row, column]) and np.nanmax(found.errors) < 1e-4
    assert found.score.normal_degrees is None, "there are no normals"
    with pytest.raises(ValueError, match="hits: needed the shape of the rays"):
        surface.compare(mine, rays[0], rays[1][1:])


def test_hits_of_arrays_say_what_they_are() -> None:
    hits = Hits.of([1.5, np.inf, np.nan])
    assert hits.verdicts.tolist() == [Verdict.HIT, Verdict.MISS, Verdict.UNDECIDED]
    assert not hits.has_normals and hits.normals.shape == (3, 3)
    with pytest.raises(ValueError, match="hits: needed verdicts of shape"):
        Hits.of([1.0], verdicts=[1, 1])
    with pytest.raises(ValueError, match="verdicts: needed numbers from 0 to 3, found 7"):
        lone = Hits.of([[1.0]], verdicts=[[7]])
        lone.save("never.npy")
