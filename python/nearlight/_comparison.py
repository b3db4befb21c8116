# SPDX-License-Identifier: Apache-2.0
"""Compares samplers on a scene."""

from __future__ import annotations

import dataclasses
import math
import statistics
import time
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ._core import Policy, SamplerKind, SamplingSettings, diff
from ._errors import InvalidArgument

if TYPE_CHECKING:
    from . import GatherSettings, Image, Session, View

_COLUMNS = ("sampler", "vpl_count", "rmse", "±", "relative MSE", "mean ratio", "FLIP", "sample s", "gather s")


@dataclasses.dataclass(frozen=True)
class ComparisonRow:
    """The error of one sampler at one number of VPLs, as means over the seeds."""

    sampler: str
    policy: str
    vpl_count: int
    seeds: int
    rmse: float
    rmse_deviation: float  #: standard error of rmse; NaN for a single seed
    relative_mse: float
    mean_ratio: float
    flip: float
    sample_seconds: float
    gather_seconds: float

    def _cells(self) -> list[str]:
        name = self.sampler if self.sampler != "close_range" else f"{self.sampler}/{self.policy}"
        errors = (self.rmse, self.rmse_deviation, self.relative_mse, self.mean_ratio, self.flip)
        seconds = (self.sample_seconds, self.gather_seconds)
        return [name, str(self.vpl_count), *(f"{e:.4g}" for e in errors), *(f"{s:.3f}" for s in seconds)]


class Comparison(list[ComparisonRow]):
    """A list of ComparisonRow that prints as a table, and shows itself as one in notebooks."""

    def __str__(self) -> str:
        lines = [list(_COLUMNS), *(row._cells() for row in self)]
        widths = [max(len(line[i]) for line in lines) for i in range(len(_COLUMNS))]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(line, widths)) for line in lines)

    def _repr_html_(self) -> str:
        head = "".join(f'<th scope="col">{name}</th>' for name in _COLUMNS)
        body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row._cells()) + "</tr>" for row in self)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def compare(
    session: Session,
    view: View,
    reference: Image,
    samplers: Iterable[SamplerKind | str | SamplingSettings] = ("close_range", "instant_radiosity"),
    vpl_counts: Iterable[int] = (1000,),
    seeds: int = 4,
    layer: str = "beauty",
    gather: GatherSettings | None = None,
) -> Comparison:
    """Renders a view with several samplers, and compares the pictures with a reference of the same size.

    session, view: where to render; all samplers share them.
    reference: an Image of what the scene should look like, as `nearlight reference` makes it.
    samplers: SamplerKind, their names, or SamplingSettings for all else, whose vpl_count is replaced.
    vpl_counts: numbers of VPLs, each of which is measured.
    seeds: how many seeds to average over, at least 1; they count from 0.
    layer: the layer that is compared.
    gather: GatherSettings; by default those of Session.gather().

    Returns a Comparison. The program's `nearlight compare` does more: clamped references, equal errors, plots.
    """
    if seeds < 1:
        raise InvalidArgument(f"seeds is {seeds}; it must be at least 1", "invalid_argument", "seeds", 2)
    counts = list(vpl_counts)
    rows = Comparison()
    for sampler in samplers:
        settings = sampler if isinstance(sampler, SamplingSettings) else SamplingSettings(sampler=sampler)
        # This compiles the sampler's kernels, and the gather's for its VPLs, before clocks run.
        session.gather(view, session.sample(view, settings, vpl_count=100), gather)
        for vpl_count in counts:
            rows.append(_measure(session, view, reference, settings, vpl_count, seeds, layer, gather))
    return rows


def _measure(
    session: Session,
    view: View,
    reference: Image,
    settings: SamplingSettings,
    vpl_count: int,
    seeds: int,
    layer: str,
    gather: GatherSettings | None,
) -> ComparisonRow:
    differences = []
    sample_seconds = []
    gather_seconds = []
    for seed in range(seeds):
        start = time.perf_counter()
        vpls = session.sample(view, settings, seed=seed, vpl_count=vpl_count)
        middle = time.perf_counter()
        picture = session.gather(view, vpls, gather, seed=seed)
        gather_seconds.append(time.perf_counter() - middle)
        sample_seconds.append(middle - start)
        differences.append(diff(picture.image, reference, layer))
    errors = [difference.rmse for difference in differences]
    return ComparisonRow(
        sampler=SamplerKind(settings.sampler).name,
        policy=Policy(settings.policy).name,
        vpl_count=vpl_count,
        seeds=seeds,
        rmse=statistics.fmean(errors),
        rmse_deviation=statistics.stdev(errors) / math.sqrt(seeds) if seeds > 1 else math.nan,
        relative_mse=statistics.fmean(difference.relative_mse for difference in differences),
        mean_ratio=statistics.fmean(difference.mean_ratio for difference in differences),
        flip=statistics.fmean(difference.flip for difference in differences),
        sample_seconds=statistics.median(sample_seconds),
        gather_seconds=statistics.median(gather_seconds),
    )
