# SPDX-License-Identifier: Apache-2.0
"""Do two sets of noisy pictures have the same expectation?

A set is an array (seeds, rows of blocks, columns of blocks, 3): the means of square blocks of pixels, one picture for
each seed. Nothing here knows who rendered them.
"""
from dataclasses import dataclass, field
import functools
import math

import numpy as np

MEAN_TOLERANCE = 0.005   # of the ratio of means
BLOCK_TOLERANCE = 0.02   # of the mean of a block
DARK = 0.05              # blocks darker than this share of the picture's mean are measured against that share
TAIL = 0.00135           # probability beyond three standard errors on one side
BLOCK_SIGMAS = 4.0       # standard errors that the noise of one of a few hundred block means is granted
MAX_MEAN_DOUBT = 0.015   # a larger uncertainty of the ratio could hide an error of 3 %
MAX_BLOCK_DOUBT = 0.12   # the same for half of the blocks


@dataclass
class Agreement:
    """What a comparison found. `verdict` is one of agrees, deviates, noisy."""
    verdict: str
    ratio: float          # mean of the first set ÷ mean of the second
    ratio_error: float    # its standard error
    block_excess: float   # largest relative deviation of a block, less the noise that it is granted
    block_deviation: float  # relative deviation of that block
    block_sigmas: float   # the same in standard errors
    block_at: tuple = field(default=(0, 0))  # its row and column
    block_doubt: float = 0.0                 # noise that the median block is granted
    seeds: tuple = field(default=(0, 0))
    is_clear: bool = False   # deviates so far that more pictures would not change the verdict


def block_means(picture, block):
    """Means of the blocks of a picture (height, width, channels). What does not fill a block is left out."""
    rows, columns = picture.shape[0] // block, picture.shape[1] // block
    whole = picture[:rows * block, :columns * block].astype(np.float64)
    return whole.reshape(rows, block, columns, block, -1).mean(axis=(1, 3))


@functools.lru_cache(maxsize=None)
def student_quantile(freedom, tail=TAIL):
    """The value that a Student-distributed variable exceeds with probability `tail`, found on a table of its integral."""
    angle = np.linspace(0.0, math.pi / 2, 20001)[:-1]    # t = sqrt(freedom)·tan(angle)
    density = np.cos(angle) ** (freedom - 1)
    above = np.cumsum(density[::-1])[::-1]
    above *= 0.5 / above[0]
    return math.sqrt(freedom) * math.tan(np.interp(-tail, -above, angle))


def compare(ours, theirs):
    """Compares two sets of block means."""
    ratio, ratio_error, freedom = _ratio_of_means(ours, theirs)
    doubt = student_quantile(round(freedom, 1)) * ratio_error
    deviation, error = _block_deviations(ours, theirs)
    excess = np.abs(deviation) - BLOCK_SIGMAS * error
    worst = np.unravel_index(np.argmax(excess), excess.shape)
    result = Agreement(
        verdict='', ratio=ratio, ratio_error=ratio_error, block_excess=max(0.0, float(excess[worst])),
        block_deviation=float(deviation[worst]), block_sigmas=float(abs(deviation[worst]) / max(error[worst], 1e-12)),
        block_at=(int(worst[0]), int(worst[1])), block_doubt=float(BLOCK_SIGMAS * np.median(error)),
        seeds=(len(ours), len(theirs)))
    if abs(ratio - 1) > max(MEAN_TOLERANCE, doubt) or result.block_excess > BLOCK_TOLERANCE:
        result.verdict = 'deviates'
        result.is_clear = abs(ratio - 1) > 2 * max(MEAN_TOLERANCE, doubt) or (
            result.block_excess > 2 * BLOCK_TOLERANCE and result.block_sigmas > 2 * BLOCK_SIGMAS)
    elif doubt > MAX_MEAN_DOUBT or result.block_doubt > MAX_BLOCK_DOUBT:
        result.verdict = 'noisy'
    else:
        result.verdict = 'agrees'
    return result


def mean_error(blocks):
    """Relative standard error of the mean of a set of pictures."""
    means = blocks.mean(axis=(1, 2, 3))
    return float(means.std(ddof=1) / math.sqrt(len(means)) / max(abs(means.mean()), 1e-12))


def _ratio_of_means(ours, theirs):
    """The ratio of means, its standard error, and that error's degrees of freedom (Welch and Satterthwaite)."""
    means = [blocks.mean(axis=(1, 2, 3)) for blocks in (ours, theirs)]
    variances = [m.var(ddof=1) / len(m) / max(m.mean(), 1e-12) ** 2 for m in means]
    total = sum(variances)
    ratio = _divided(means[0].mean(), means[1].mean())
    if total == 0:
        return ratio, 0.0, 1
    freedom = total ** 2 / sum(v ** 2 / (len(m) - 1) for v, m in zip(variances, means))
    return ratio, abs(ratio) * math.sqrt(total), freedom


def _divided(ours, theirs):
    """Two black pictures agree."""
    if abs(theirs) < 1e-9:
        return 1.0 if abs(ours) < 1e-9 else math.inf
    return float(ours / theirs)


def _block_deviations(ours, theirs):
    """Relative deviations of all blocks and channels, and their standard errors."""
    mean = theirs.mean(axis=0)
    scale = np.maximum(mean, max(DARK * max(mean.mean(), ours.mean()), 1e-12))
    error = np.sqrt(_block_variance(ours) + _block_variance(theirs))
    return (ours.mean(axis=0) - mean) / scale, error / scale


def _block_variance(blocks):
    """Variance of the mean of each block. Few seeds estimate it badly, so it is no less than around it, over 3x3 blocks."""
    own = blocks.var(axis=0, ddof=1) / len(blocks)
    padded = np.pad(own.mean(axis=2), 1, mode='edge')
    rows, columns = own.shape[:2]
    around = sum(padded[y:y + rows, x:x + columns] for y in range(3) for x in range(3)) / 9
    return np.maximum(own, around[..., None])
