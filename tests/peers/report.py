# SPDX-License-Identifier: Apache-2.0
"""docs/mitsuba-support.md: what agrees with Mitsuba, what is refused, what deviates."""
from itertools import groupby
import re

HEAD = '''# Beside Mitsuba 3

<!-- Made by tests/peers; do not edit. -->
This page is made by this command, with nearlight {ours} and Mitsuba {theirs}:

    {command}

Each row is a small scene (`tests/peers/rows/`) that both renderers render: nearlight at its defaults, Mitsuba with the
integrator that the file names, until its own noise is small. The last column has what nearlight said, and for rows that
deviate the reason, where it is known.

*Ratio* is the mean of nearlight's pictures ÷ the mean of Mitsuba's, with its standard error. *Block* is the largest
deviation of the mean of 8 × 8 pixels (fewer for sensors, textures and filters), in one colour, after the noise of both
renderers is taken off. A row *agrees* if the ratio is within 0.5 % of 1 (or within its noise, which may be 1.5 % at most)
and the block within 2 %. What nearlight *refuses* ends it with exit code 3.

'''
# Why rows deviate, where that is known.
SMOOTH_LAMPS = ("Mitsuba's light samples of smooth meshes take their density by the shading normal, so that they disagree with its "
                "own BSDF samples (`direct` with either alone); this picture agrees with those, and with both under `face_normals`")
REASONS = {
    'emitters/area-ply': SMOOTH_LAMPS,
    'emitters/area-wave': SMOOTH_LAMPS,
    'bsdfs/blendbsdf-smooth/area': "Mitsuba's picture is less than the sum of the two parts that it blends, by a tenth "
                                   'where the metal mirrors the lamp',
    'shapes/rotation-about-long-axis': 'Mitsuba turns normals by the same matrix, as if it were a rotation',
}
KINDS = ('agrees', 'deviates', 'noisy', 'refused', 'failed', 'no peer')
BOLD = ('deviates', 'failed')


def write(path, results, command, ours, theirs):
    results = [r for r in results if not r.name.startswith('planted/')]
    text = HEAD.format(command=command, ours=ours, theirs=theirs) + _summary(results)
    for group, rows in groupby(results, key=_group):
        text += (f'\n## {group}\n\n| scene | result | ratio | block | what nearlight said, or why it deviates |\n'
                 '|---|---|---|---|---|\n' + ''.join(_line(r) for r in rows))
    with open(path, 'w', encoding='utf-8') as file:
        file.write(text)


def _group(result):
    return result.name.split('/')[0]


def _summary(results):
    kinds = [kind for kind in KINDS if any(r.status == kind for r in results)]
    lines = ['| group | ' + ' | '.join(kinds) + ' |', '|---|' + '---:|' * len(kinds)]
    for group, rows in [(g, list(r)) for g, r in groupby(results, key=_group)] + [('all', results)]:
        lines.append(f'| {group} | ' + ' | '.join(str(sum(r.status == kind for r in rows) or '') for kind in kinds) + ' |')
    return '\n'.join(lines) + '\n'


def _line(result):
    name = result.name.split('/', 1)[1]
    ratio = block = ''
    if result.agreement:
        ratio = f'{result.agreement.ratio:.4f} ± {result.agreement.ratio_error:.4f}'
        block = f'{result.agreement.block_excess:.1%}'
    notes = [result.note] if result.note else result.warnings
    if result.status == 'deviates' and result.name in REASONS:
        notes = [REASONS[result.name], *notes]
    status = f'**{result.status}**' if result.status in BOLD else result.status
    return f'| {name} | {status} | {ratio} | {block} | {"; ".join(_escaped(n) for n in notes)} |\n'


def _escaped(text):
    """A message without the place in the scene's file, and without what Markdown would take for its own."""
    return re.sub(r'^\S+\.xml:\d+: ', '', text).replace('|', '\\|').replace('<', '&lt;')
