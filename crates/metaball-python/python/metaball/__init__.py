"""Particles as smooth surfaces, ray traced exactly on the CPU.

A particle adds q·k(r²/R²) to a field, where r is the distance to its centre, R its support radius, q its
strength and k the kernel; the surface is where the field equals the threshold T.

>>> import numpy as np
>>> import metaball
>>> particles = metaball.Particles(np.random.default_rng(0).random((100, 3)), support_radius=0.3)
>>> surface = metaball.Surface(particles, kernel="quartic", threshold=0.25)
>>> image = surface.render(size=(320, 240), shadows=True)
>>> image.save("balls.png")  # doctest: +SKIP
"""

from ._metaball import __version__
from .arrays import Floats
from .camera import Camera
from .comparison import Comparison, Finding, Score, Truth
from .hits import Hits, Verdict
from .image import Image
from .particles import FieldOptions, Particles, ReadOptions, ReaderWarning
from .progress import ProgressBar
from .surface import LightOptions, Surface

__all__ = [
    "Camera",
    "Comparison",
    "FieldOptions",
    "Finding",
    "Floats",
    "Hits",
    "Image",
    "LightOptions",
    "Particles",
    "ProgressBar",
    "ReadOptions",
    "ReaderWarning",
    "Score",
    "Surface",
    "Truth",
    "Verdict",
    "__version__",
]
