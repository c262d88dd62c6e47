#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of approximations.sh for docs/measured/results.md: python3 approximations_table.py FOLDER"""
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
        sure = (bias['low'] > 0 or bias['high'] < 0) and not cell.get('missed_light')
        yield (strategy['name'], cell['seconds']['mean'] + cell['prepare_seconds'],
               cell['relmse']['mean'], f'{100 * bias["mean"]:+.1f}' if sure else '',
               flip(folder / name / 'renders' / f'{strategy["name"].replace(":", ".")}-{cell["budget"]}-1.exr',
                    folder / f'{reference}-reference.exr'))


def mode_of(row):
    return re.sub('^[a-z]+', '', row).lstrip('+').replace('+', ', ') or 'path'


def cell_text(seconds, relmse, bias, difference):
    return f'{seconds:.2f} / {relmse:.1e} / {bias or "-"} / {difference:.3f}'


def scene_table(folder, model, scene):
    studies = sorted(path.parent.name for path in folder.glob(f'{model}-*/results.json'))
    columns = [{mode_of(row): cell_text(*rest) for row, *rest in rows(folder, name, name)} for name in studies]
    print(f'\n| {scene} | ' + ' | '.join(name.partition('-')[2] for name in studies) + ' |')
    print('| --- |' + ' ---: |' * len(studies))
    for mode in columns[0]:
        print(f'| {mode} | ' + ' | '.join(column[mode] for column in columns) + ' |')


def time_table(folder):
    studies = sorted((path.parent.name for path in folder.glob('equal-time-*/results.json')),
                     key=lambda name: int(name.rpartition('-')[2]))
    columns = [{mode_of(row): cell_text(*rest) for row, *rest in rows(folder, name, 'room-overcast')}
               for name in studies]
    print('\n| interior, overcast | ' + ' | '.join(name.rpartition('-')[2] + ' s' for name in studies) + ' |')
    print('| --- |' + ' ---: |' * len(studies))
    for mode in columns[0]:
        print(f'| {mode} | ' + ' | '.join(column[mode] for column in columns) + ' |')


def main():
    folder = pathlib.Path(sys.argv[1])
    for model, scene in SCENES.items():
        scene_table(folder, model, scene)
    time_table(folder)


if __name__ == '__main__':
    main()
