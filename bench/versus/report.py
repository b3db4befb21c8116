# SPDX-License-Identifier: Apache-2.0
"""The report of a race: a Markdown file, and an SVG plot beside it for each scene and measure."""
import os

import numpy as np

import measures
import plots

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'README.md')
MEASURES = {'relative_mse': 'relative MSE', 'flip': 'FLIP'}
EXPONENTS = {'relative_mse': 1, 'flip': 0.5}     # errors of pictures without bias fall as seconds to the power of minus this
CLOCKS = {'render': 'seconds of rendering', 'process': 'seconds of the whole process', 'processor': 'processor seconds'}


def write(file, results, notes, arguments):
    base, name = os.path.split(file)
    folder = os.path.join(base, os.path.splitext(name)[0].lower() + '-plots')
    os.makedirs(folder, exist_ok=True)
    lines = introduction(arguments, notes, os.path.relpath(README, base or '.'))
    for result in results:
        lines += scene_lines(result, folder, base, arguments)
    with open(file + '.partial', 'w', encoding='utf-8') as out:
        out.write('\n'.join(lines) + '\n')
    os.replace(file + '.partial', file)


def introduction(arguments, notes, readme):
    return ['# nearlight beside path tracers', '',
            f'Written by `bench/versus/versus.py` ([README]({readme}) says what is measured and how).', '',
            f'{arguments.seeds} seeds a point, pictures of {arguments.size}; seconds are medians. '
            f'Plots are over the {CLOCKS[arguments.clock]}; bars go from the least to the largest of the seeds, dashed lines are '
            'denoised pictures.', '', *[f'- {note}' for note in notes], '']


def median(runs, measure):
    return float(np.median([run[measure] for run in runs]))


def clock(runs, name):
    return float(np.median([run['seconds'][name] for run in runs]))


def scene_lines(result, folder, base, arguments):
    lines = [f"## {result['scene']}", '']
    for pair in result['agreement']:
        lines.append(f"Converged means, {pair['renderers'][0]} ÷ {pair['renderers'][1]}: {pair['ratio']:.4f} ± {pair['error']:.4f}. ")
    for limit, error in result['truth_relative_mse'].items():
        lines.append(f"The truth of {limit} has a relative MSE of its own of about {error:.1e}. ")
    lines += [*[f'{note}. ' for note in result['notes']], '']
    for measure, name in MEASURES.items():
        stem = f"{result['scene']}-{measure.replace('_', '-')}.svg"
        with open(os.path.join(folder, stem), 'w', encoding='utf-8') as out:
            out.write(error_plot(result, measure, arguments.clock))
        path = os.path.relpath(os.path.join(folder, stem), base or '.')
        lines.append(f"![{name} of {result['scene']}]({path})")
    lines += ['', *ratio_table(result), '', *point_table(result), '', *spectrum_table(result), '']
    return lines


def error_plot(result, measure, clock_name):
    rows = []
    for curve in result['curves']:
        points = []
        for point in curve['points']:
            values = [run[measure] for run in point['runs']]
            points.append((clock(point['runs'], clock_name), min(values), float(np.median(values)), max(values)))
        rows.append((curve['renderer'], points, curve['denoised']))
    return plots.svg(result['scene'], CLOCKS[clock_name], MEASURES[measure], rows)


def ratio_table(result):
    """Seconds of each path tracer to the least error that it and nearlight both reach, over nearlight's seconds to that.
    measures.ratio_to_equal() says what the marks ~, > and < mean."""
    lines = ['| to equal | clock | ' + ' | '.join(names(result)) + ' |', '|---|---|' + '---:|' * len(names(result))]
    for denoised in (False, True):
        curves = {c['renderer']: c['points'] for c in result['curves'] if c['denoised'] == denoised}
        if 'nearlight' not in curves:
            continue
        for measure, name in MEASURES.items():
            for clock_name in CLOCKS:
                cells = [ratio_text(curves['nearlight'], curves.get(other), measure, clock_name, denoised) for other in names(result)]
                label = name + (', denoised' if denoised else ', raw')
                lines.append(f'| {label} | {clock_name} | ' + ' | '.join(cells) + ' |')
    return lines


def names(result):
    return [n for n in dict.fromkeys(c['renderer'] for c in result['curves']) if n != 'nearlight']


def ratio_text(ours, theirs, measure, clock_name, denoised):
    if theirs is None:
        return ''
    results = []
    for seed in range(min(len(ours[0]['runs']), len(theirs[0]['runs']))):
        curves = [([p['runs'][seed]['seconds'][clock_name] for p in points], [p['runs'][seed][measure] for p in points])
                  for points in (ours, theirs)]
        results.append(measures.ratio_to_equal(*curves, None if denoised else EXPONENTS[measure]))
    ratios = [ratio for ratio, _ in results]
    marks = {mark for _, mark in results}
    mark = '~' if marks >= {'<', '>'} else max(marks)      # of seeds that bound the ratio from both sides, neither bound holds
    return f'{mark} {np.median(ratios):.2g} ({min(ratios):.2g} to {max(ratios):.2g})'.strip()


def point_table(result):
    lines = ['| renderer | work | render s | process s | processor s | relative MSE | FLIP |', '|---|---:|---:|---:|---:|---:|---:|']
    for curve in result['curves']:
        name = curve['renderer'] + (', denoised' if curve['denoised'] else '')
        for point in curve['points']:
            runs = point['runs']
            lines.append(f"| {name} | {point['work']} | {clock(runs, 'render'):.2f} | {clock(runs, 'process'):.2f} | "
                         f"{clock(runs, 'processor'):.2f} | {median(runs, 'relative_mse'):.5f} | {median(runs, 'flip'):.4f} |")
    return lines


def spectrum_table(result):
    """The error's spectrum at the last point of each curve, in a few bands."""
    rows = []
    for curve in result['curves']:
        spectra = [run['spectrum'] for run in curve['points'][-1]['runs']]
        power = np.mean([[p for _, p in spectrum] for spectrum in spectra], axis=0)
        rows.append((curve['renderer'] + (', denoised' if curve['denoised'] else ''), power))
    frequencies = [f for f, _ in result['curves'][0]['points'][-1]['runs'][0]['spectrum']]
    lines = ['Power of the error by frequency (cycles a pixel), white noise being 1, at the most work:', '',
             '| | ' + ' | '.join(f'{f:.3f}' for f in frequencies) + ' |', '|---|' + '---:|' * len(frequencies)]
    return lines + [f'| {name} | ' + ' | '.join(f'{p:.2g}' for p in power) + ' |' for name, power in rows]
