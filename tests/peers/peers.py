#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders small scenes with nearlight and with Mitsuba 3 and says where the two differ.

Needs the Python packages mitsuba and numpy (pip install mitsuba numpy); without them it prints one line and ends with
exit code 77, which ctest counts as skipped.
"""
import argparse
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
import fnmatch
import importlib.metadata
import importlib.util
import json
import os
import shlex
import subprocess
import sys
import time

SKIPPED = 77
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def missing_packages():
    return [name for name in ('numpy', 'mitsuba') if importlib.util.find_spec(name) is None]


def seeds_of(text):
    """The seeds of --chance."""
    first, dash, last = text.partition('-')
    if not first.isdecimal() or not (last if dash else first).isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is neither a seed nor a range such as 0-99")
    return range(int(first), int(last or first) + 1)


def parsed_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('patterns', nargs='*', help="rows to run, such as 'emitters/*' or 'glass'; all without")
    parser.add_argument('--nearlight', default=os.path.join(ROOT, 'build/release/nearlight'), help='the program')
    parser.add_argument('--out', default=os.path.join(ROOT, 'build/peers'), help="folder of the scenes and Mitsuba's pictures")
    parser.add_argument('--jobs', type=int, default=1, help='rows at a time')
    parser.add_argument('--fast', action='store_true', help='only the subset that ctest runs')
    parser.add_argument('--list', action='store_true', help='list the rows and end')
    parser.add_argument('--json', action='store_true', help='print results as one JSON object')
    parser.add_argument('--clamp-radius-factor', type=float, default=1, help="times the clamp radius of nearlight's own choice")
    parser.add_argument('--reference', metavar='SPP', type=int, default=0,
                        help="compare `nearlight reference`, the oracle of nearlight's own tests, with so many samples a pixel")
    parser.add_argument('--rooms', metavar='FOLDER', action='append', default=[],
                        help='also compare all XML scenes under this folder, as rows rooms/...')
    parser.add_argument('--chance', metavar='SEEDS', type=seeds_of, default=(),
                        help='also compare rooms made by chance, as rows chance/...: a seed, or a range such as 0-99')
    parser.add_argument('--size', default='128x96', help='greatest size of the pictures of --rooms')
    parser.add_argument('--options', default='', help='further options for nearlight, in one string')
    parser.add_argument('--resume', action='store_true', help='keep the results that this very program got before')
    parser.add_argument('--redo', action='store_true', help="make Mitsuba's pictures anew")
    parser.add_argument('--write-docs', metavar='FILE', help='write the table of docs/mitsuba-support.md')
    return parser.parse_args()


def chosen(rows, arguments):
    """The rows that the patterns name; a name without a star is that of a group, or of a row."""
    patterns = [form for pattern in arguments.patterns or ['*'] for form in (pattern, pattern.rstrip('/') + '/*')]
    return [row for row in rows if any(fnmatch.fnmatch(row.name, p) for p in patterns)]


def main():
    arguments = parsed_arguments()
    missing = missing_packages()
    if missing and not arguments.list:
        print(f"skipped: the comparison with Mitsuba needs the Python package {' and '.join(missing)} (pip install mitsuba)")
        return SKIPPED
    import rooms
    import rows
    tables = rows.fast_rows() if arguments.fast else rows.all_rows()
    made = rooms.rows(arguments.rooms, arguments.size) + rows.chance.rows(arguments.chance)
    wanted = chosen(tables + made, arguments)
    if arguments.list:
        print('\n'.join(row.name for row in wanted))
        return 0
    if not wanted:
        print('error: no row has a name like ' + ' '.join(arguments.patterns), file=sys.stderr)
        return 2
    results = compared(wanted, arguments)
    report_all(results, arguments)
    return 0 if all(result.passed for result in results) else 1


def compared(wanted, arguments):
    """All results, in the order of the rows."""
    from comparison import Comparison
    from mitsuba_worker import Worker
    version = importlib.metadata.version('mitsuba')
    os.makedirs(arguments.out, exist_ok=True)
    workers = [Worker(os.path.join(arguments.out, f'mitsuba-{number}.log')) for number in range(arguments.jobs)]
    idle = list(workers)
    workers[0].ask({'write': os.path.join(arguments.out, 'assets')}, 120)

    def one(row):
        worker = idle.pop()
        started = time.monotonic()
        try:
            result = Comparison(arguments, version, worker).result(row)
        finally:
            idle.append(worker)
        result.seconds = time.monotonic() - started
        print(line_of(result), file=sys.stderr, flush=True)
        return result

    with ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(one, wanted))
    for worker in workers:
        worker.stop()
    return results


def line_of(result):
    text = f"{'ok  ' if result.passed else 'FAIL'} {result.status:9} {result.name:44}"
    a = result.agreement
    if a:
        text += (f' mean {a.ratio:.4f} ± {a.ratio_error:.4f}  block {a.block_deviation:+.1%} ({a.block_sigmas:.0f} sigma),'
                 f' beyond noise {a.block_excess:.1%}')
    return f'{text} {result.note}  [{result.seconds:.1f} s]'


def report_all(results, arguments):
    failed = [r for r in results if not r.passed]
    if arguments.json:
        rows = [asdict(result) for result in results]
        print(json.dumps({'rows': rows, 'failed': [r.name for r in failed], 'pass': not failed}, indent=1))
    print(f'{len(results) - len(failed)} of {len(results)} rows pass', file=sys.stderr)
    if arguments.write_docs:
        import report
        command = 'tests/peers/peers.py ' + ' '.join(shlex.quote(a) for a in sys.argv[1:])
        ours = subprocess.run([arguments.nearlight, '--version'], capture_output=True, text=True, check=True).stdout.split()[-1]
        report.write(arguments.write_docs, results, command, ours, importlib.metadata.version('mitsuba'))


if __name__ == '__main__':
    sys.exit(main())
