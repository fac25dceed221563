"""The volume of the solid, from the lengths that parallel rays have in it."""

import sys
from pathlib import Path

import numpy as np

import metaball


def volume(surface: metaball.Surface, rays: int = 256) -> float:
    """Sums all stretches inside of rays along z, in the unit of length, cubed."""
    bounds = surface.bounds
    if bounds is None:
        return 0.0
    least, greatest = np.array(bounds)
    middles = (np.arange(rays) + 0.5) / rays
    x, y = np.meshgrid(*(least[:2, None] + (greatest - least)[:2, None] * middles))
    origins = np.stack([x, y, np.full_like(x, least[2])], axis=-1)
    length, start = 0.0, np.zeros_like(x)
    while True:
        entries = surface.trace(origins, [0, 0, 1], t_min=start)
        hit = entries.is_hit
        if not hit.any():
            break
        origins, entered = origins[hit], entries.t[hit].astype(np.float64)
        exits = surface.exit(origins, [0, 0, 1], t_min=np.nextafter(entered, np.inf) + 1e-6)
        start = exits.t.astype(np.float64)
        length += float(np.sum(start - entered))
        start = start + 1e-6
    return length * float(np.prod((greatest - least)[:2])) / rays**2


def main(folder: Path) -> None:
    # A ball alone shows at its radius, so the volume is known.
    lone = metaball.Surface(metaball.Particles([[0.0, 0.0, 0.0]], radius=1.0))
    found, known = volume(lone), 4 / 3 * np.pi
    assert abs(found / known - 1) < 1e-3, (found, known)
    particles = metaball.Particles(np.random.default_rng(0).random((200, 3)), radius=0.1)
    text = f"a ball: {found:.5f}, in truth {known:.5f}; 200 that merge: {volume(metaball.Surface(particles)):.5f}"
    print(text)
    (folder / "volume.txt").write_text(text + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
