#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of approximations.sh for RESULTS.md: python3 approximations_table.py FOLDER"""
import json
import pathlib
import re
import subprocess
import sys

SCENES = {'lambertian': 'open', 'room': 'interior', 'conductors': 'metals'}


def flip(folder, name, mode):
    render = folder / name / 'renders' / f'{mode.replace(":", ".")}-64spp-1.exr'
    out = subprocess.run(['build/chromeball', 'image', 'error', render,
                          folder / f'{name}-reference.exr', '--flip', '--json'],
                         check=True, capture_output=True, text=True)
    return json.loads(out.stdout)['flip']


def rows(folder, name):
    result = json.loads((folder / name / 'results.json').read_text())
    for strategy in result['strategies']:
        cell = strategy['cells'][-1]
        bias = cell['bias']
        sure = bias['low'] > 0 or bias['high'] < 0
        yield (strategy['name'], cell['seconds']['mean'] + cell['prepare_seconds'],
               cell['relmse']['mean'], f'{100 * bias["mean"]:+.1f}' if sure else '',
               flip(folder, name, strategy['name']))


def main():
    folder = pathlib.Path(sys.argv[1])
    print('| scene | probe | mode | seconds | relMSE | bias, % | FLIP |')
    print('| --- | --- | --- | ---: | ---: | ---: | ---: |')
    for path in sorted(folder.glob('*/results.json'), key=lambda p: list(SCENES).index(p.parent.name.split('-')[0])):
        model, _, probe = path.parent.name.partition('-')
        for mode, seconds, relmse, bias, difference in rows(folder, path.parent.name):
            mode = re.sub('^[a-z]+', '', mode).lstrip('+') or 'path'
            print(f'| {SCENES[model]} | {probe} | {mode.replace("+", ", ")} | {seconds:.2f} | '
                  f'{relmse:.1e} | {bias} | {difference:.3f} |')


if __name__ == '__main__':
    main()
