"""How far a long computation is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol


class ProgressBar(Protocol):
    """A bar as tqdm's: it is told how much more is done, and closed in the end."""

    def update(self, n: int, /) -> object: ...

    def close(self) -> object: ...


Progress = bool | Callable[..., ProgressBar]
"""`True` for tqdm's bar of the terminal or notebook, or what makes a bar: called with `total` and `unit`."""


@contextmanager
def bar(progress: Progress, total: int, unit: str) -> Iterator[ProgressBar | None]:
    """A bar for so many units, closed however the computation ends; `None` where none is wanted."""
    if progress is False:
        yield None
        return
    made = (tqdm() if progress is True else progress)(total=total, unit=unit)
    try:
        yield made
    finally:
        made.close()


def tqdm() -> Callable[..., ProgressBar]:
    """The bar that suits where this runs."""
    try:
        from tqdm.auto import tqdm  # type: ignore[import-untyped]
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "progress: needed the package tqdm (pip install tqdm), or what makes a bar"
        ) from error
    made: Callable[..., ProgressBar] = tqdm
    return made
