#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of approximations.sh for RESULTS.md: python3 approximations_table.py FOLDER"""
import json
import pathlib
import re
import subprocess
import sys

SCENES = {'lambertian': 'open', 'room': 'interior', 'conductors': 'metals'}


def flip(render, reference):
    out = subprocess.run(['build/chromeball', 'image', 'error', render, reference, '--flip', '--json'],
                         check=True, capture_output=True, text=True)
    return json.loads(out.stdout)['flip']


def rows(folder, name, reference):
    result = json.loads((folder / name / 'results.json').read_text())
    for strategy in result['strategies']:
        cell = strategy['cells'][-1]
        bias = cell['bias']
        sure = bias['low'] > 0 or bias['high'] < 0
        yield (strategy['name'], cell['seconds']['mean'] + cell['prepare_seconds'],
               cell['relmse']['mean'], f'{100 * bias["mean"]:+.1f}' if sure else '',
               flip(folder / name / 'renders' / f'{strategy["name"].replace(":", ".")}-{cell["budget"]}-1.exr',
                    folder / f'{reference}-reference.exr'))


def print_table(head, lines):
    print(f'| {head} | mode | seconds | relMSE | bias, % | FLIP |')
    print('| --- |' * (2 + head.count('|')) + ' ---: |' * 4)
    for first, (mode, seconds, relmse, bias, difference) in lines:
        mode = re.sub('^[a-z]+', '', mode).lstrip('+') or 'path'
        print(f'| {first} | {mode.replace("+", ", ")} | {seconds:.2f} | {relmse:.1e} | {bias} | {difference:.3f} |')
    print()


def main():
    folder = pathlib.Path(sys.argv[1])
    studies = [path.parent.name for path in folder.glob('*/results.json')]
    scenes = sorted((name for name in studies if name.split('-')[0] in SCENES),
                    key=lambda name: (list(SCENES).index(name.split('-')[0]), name))
    print_table('scene | probe', [(f'{SCENES[name.split("-")[0]]} | {name.split("-")[1]}', row)
                                  for name in scenes for row in rows(folder, name, name)])
    times = sorted(name for name in studies if name.startswith('equal-time'))
    print_table('time', [(name.rpartition('-')[2] + ' s', row)
                         for name in times for row in rows(folder, name, 'room-overcast')])


if __name__ == '__main__':
    main()
