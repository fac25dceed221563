"""Surfaces that tests share."""

from __future__ import annotations

import numpy as np
import pytest

import metaball


@pytest.fixture(scope="session")
def balls() -> metaball.Particles:
    """100 coloured balls at random."""
    random = np.random.default_rng(7)
    return metaball.Particles(
        random.random((100, 3)),
        support_radius=random.uniform(0.1, 0.3, 100),
        strength=random.uniform(0.5, 2.0, 100),
        color=random.random((100, 3)),
    )


@pytest.fixture(scope="session")
def surface(balls: metaball.Particles) -> metaball.Surface:
    """Theirs."""
    return metaball.Surface(balls)


@pytest.fixture(scope="session")
def lone() -> metaball.Surface:
    """One ball at the origin, which the quartic lets show at √2."""
    return metaball.Surface(metaball.Particles(np.zeros((1, 3)), support_radius=2.0))
