#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders scenes with nearlight and with path tracers, and shows the error of each over the seconds that it took.

Needs the Python packages mitsuba and numpy, and bpy for Cycles. Renderers that are not installed are left out with a line that says why.
"""
import argparse
import importlib.util
import json
import os
import sys

SKIPPED = 77
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def parsed_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('scenes', nargs='+', help='Mitsuba XML files, or glTF files, which are converted to such')
    parser.add_argument('--nearlight', default=os.path.join(ROOT, 'build/release/nearlight'), help='the program')
    parser.add_argument('--out', default=os.path.join(ROOT, 'build/versus'), help='folder of all pictures and results; what is '
                        'there is not rendered again')
    parser.add_argument('--size', default='320x240', help='of the pictures')
    parser.add_argument('--seeds', type=int, default=5, help='pictures for each point of a curve')
    parser.add_argument('--seconds', type=float, default=60, help='a curve goes on until a picture takes longer')
    parser.add_argument('--doublings', type=int, default=10, help='maximum points of a curve: 1, 2, 4, ... passes, or times 16 samples')
    parser.add_argument('--truth', type=int, nargs=2, default=(64, 128), metavar=('PASSES', 'WORK'),
                        help='passes of nearlight, and times 16 samples of others, for each half of a converged picture')
    parser.add_argument('--only', default='', help='renderers whose names contain one of these, separated by commas, besides nearlight')
    parser.add_argument('--pictures', choices=('both', 'raw', 'denoised'), default='both', help='which are raced')
    parser.add_argument('--limit', type=float, default=7200, help='maximum seconds of one picture')
    parser.add_argument('--clock', choices=('render', 'process', 'processor'), default='render', help='the seconds of the plots')
    parser.add_argument('--write', metavar='FILE', help='write the report there, and its plots beside it')
    return parser.parse_args()


def chosen_renderers(arguments):
    """The renderers that are there, nearlight first, and lines about the others."""
    from renderers import Cycles, Mitsuba, Nearlight
    nearlight = Nearlight(arguments.nearlight, arguments.out, arguments.limit)
    others = [Mitsuba('llvm_ad_rgb', arguments.out, arguments.limit), Mitsuba('scalar_rgb', arguments.out, arguments.limit),
              Cycles(False, arguments.out, arguments.limit), Cycles(True, arguments.out, arguments.limit)]
    wanted = [nearlight] + [r for r in others if any(part in r.label.lower() for part in arguments.only.lower().split(','))]
    absent = [f'{r.label} is left out: {r.missing()}' for r in wanted if r.missing()]
    return nearlight, [r for r in wanted if not r.missing()], absent


def run(arguments):
    from race import Race
    from renderers import RenderFailure, can_denoise, mitsuba_file
    import report
    os.makedirs(arguments.out, exist_ok=True)
    nearlight, renderers, notes = chosen_renderers(arguments)
    if nearlight not in renderers:
        print('skipped: ' + notes[0])
        return SKIPPED
    denoise = {'both': (False, True), 'raw': (False,), 'denoised': (True,)}[arguments.pictures]
    if True in denoise and not can_denoise():
        if arguments.pictures == 'denoised':
            print('skipped: no Open Image Denoise; run scripts/setup --denoise')
            return SKIPPED
        denoise = (False,)
        notes.append('denoised pictures are left out: no Open Image Denoise; run scripts/setup --denoise')
    for note in notes:
        print(note, file=sys.stderr)
    race = Race(renderers, nearlight, arguments.out, arguments.seeds, arguments.seconds, arguments.doublings,
                tuple(arguments.truth), denoise)
    size = tuple(int(n) for n in arguments.size.split('x'))
    results, failures = [], 0
    for path in arguments.scenes:
        print(path, file=sys.stderr)
        try:
            readable = mitsuba_file(path, arguments.out, arguments.limit)
            results.append(race.scene(readable, size, lambda line: print('  ' + line, file=sys.stderr, flush=True)))
        except RenderFailure as failure:
            failures += 1
            notes.append(f'{path} failed: {failure}')
            print(notes[-1], file=sys.stderr)
    with open(os.path.join(arguments.out, 'versus.json'), 'w', encoding='utf-8') as file:
        json.dump({'scenes': results, 'notes': notes}, file, indent=1)
    if arguments.write:
        report.write(arguments.write, results, notes, arguments)
    return 1 if failures else 0


def main():
    arguments = parsed_arguments()
    absent = [name for name in ('numpy', 'mitsuba') if importlib.util.find_spec(name) is None]
    if absent:
        print(f"skipped: the race needs the Python package {' and '.join(absent)} (pip install mitsuba numpy)")
        return SKIPPED
    return run(arguments)


if __name__ == '__main__':
    status = main()
    sys.stdout.flush()
    os._exit(status)     # Mitsuba's threads may hang at exit
