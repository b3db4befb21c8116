# SPDX-License-Identifier: Apache-2.0
"""What is measured on pictures, as arrays of height x width x RGB, and on curves of error over seconds."""
import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
TRIMMED = 0.001          # the share of pixels, those of the largest errors, that the relative MSE leaves out
BANDS = 12               # of the error's spectrum


def luminance(picture):
    return np.asarray(picture, dtype=np.float64) @ LUMINANCE


def relative_mse(picture, truth):
    """The mean of (a - b)^2 / (b^2 + 0.01) over pixels, without the TRIMMED largest, since a few fireflies would decide."""
    a, b = luminance(picture), luminance(truth)
    errors = np.sort(((a - b) ** 2 / (b ** 2 + 0.01)).ravel())
    return float(errors[:max(1, int(len(errors) * (1 - TRIMMED)))].mean())


def spectrum(picture, truth):
    """The power of the error by its frequency: BANDS pairs of a frequency in cycles a pixel and the mean power there, relative
    to white noise of the same power as 1. Correlated noise has its power at low frequencies."""
    error = (luminance(picture) - luminance(truth)) / np.sqrt(luminance(truth) ** 2 + 0.01)
    limit = np.quantile(np.abs(error), 1 - TRIMMED)
    error = np.clip(error, -limit, limit)
    power = np.abs(np.fft.fft2(error)) ** 2 / error.size
    y, x = (np.fft.fftfreq(n)[:, None] if axis == 0 else np.fft.fftfreq(n)[None, :] for axis, n in enumerate(error.shape))
    frequency = np.hypot(x, y)
    edges = np.geomspace(1 / max(error.shape), 0.5, BANDS + 1)
    mean = max(power.mean(), 1e-30)
    rows = []
    for low, high in zip(edges, edges[1:]):
        inside = (frequency >= low) & (frequency < high)
        if inside.any():
            rows.append((float(np.sqrt(low * high)), float(power[inside].mean() / mean)))
    return rows


def seconds_to(error, seconds, errors):
    """The seconds at which a curve of errors, given at increasing seconds, reaches `error`, on straight lines through the
    logarithms; None if it does not get there. A curve that begins below has the seconds of its first point."""
    best = np.minimum.accumulate(errors)
    if best[0] <= error:
        return float(seconds[0])
    for i in range(1, len(best)):
        if best[i] <= error:
            share = np.log(best[i - 1] / error) / np.log(best[i - 1] / best[i])
            return float(np.exp(np.log(seconds[i - 1]) + share * np.log(seconds[i] / seconds[i - 1])))
    return None


def ratio_to_equal(ours, theirs, exponent):
    """How many times longer `theirs` takes to the least error that both reach; curves are pairs of seconds and errors.

    Where ours begins below all that theirs reaches, the error is that of our first point, and theirs goes on from its last point as
    seconds to the power of -`exponent`, or stops there if `exponent` is None. Where theirs begins below all that ours reaches, theirs
    has the seconds of its first point, though it may have got there sooner. Returns the ratio and how it is to be read: '' as it is,
    '~' as continued, '>' as a lower bound, '<' as an upper bound.
    """
    if min(theirs[1]) <= ours[1][0]:
        error = max(min(ours[1]), min(theirs[1]))
        return seconds_to(error, *theirs) / seconds_to(error, *ours), '<' if theirs[1][0] < error else ''
    best = int(np.argmin(theirs[1]))
    if exponent is None:
        return theirs[0][best] / ours[0][0], '>'
    return theirs[0][best] * (theirs[1][best] / ours[1][0]) ** (1 / exponent) / ours[0][0], '~'


def combined(pictures):
    """One picture from several renderers' converged ones, each given as independent halves: their mean, weighted by the
    inverse of their variances. Returns it and its relative variance."""
    means = [np.mean(halves, axis=0) for halves in pictures]
    variances = [max(relative_mse(halves[0], halves[1]) / 4, 1e-12) for halves in pictures]
    weights = [1 / v for v in variances]
    return sum(w * m for w, m in zip(weights, means)) / sum(weights), 1 / sum(weights)


def mean_ratio(halves, others):
    """The ratio of two renderers' mean luminance, and its standard error, from independent halves of each."""
    def mean_and_error(pair):
        values = [luminance(picture).mean() for picture in pair]
        return np.mean(values), abs(values[0] - values[1]) / 2
    (a, da), (b, db) = mean_and_error(halves), mean_and_error(others)
    return a / b, a / b * np.hypot(da / a, db / b)
