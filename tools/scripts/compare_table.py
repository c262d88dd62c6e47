#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the tables of docs/measured/results.md from the reports of compare_all.sh: python3 compare_table.py FOLDER"""
import json
import pathlib
import sys

BASE = 'uniform'


def cell(strategy, label):
    return next((c for c in strategy['cells'] if c['budget'] == label), None)


def short(x):
    return f'{x:.2g}' if x < 100 else f'{x:.0f}'


def reports(folder):
    for path in sorted(pathlib.Path(folder).glob('*/results.json')):
        result = json.loads(path.read_text())
        scene, _, probe = path.parent.name.rpartition('-')
        yield scene, probe, result


def main():
    found = list(reports(sys.argv[1]))
    for scene in sorted({scene for scene, _, _ in found}):
        columns = [(probe, result) for s, probe, result in found if s == scene]
        label = columns[0][1]['strategies'][0]['cells'][-1]['budget']
        print(f'\n{scene}, {label}: relMSE at equal samples / efficiency / bias, %\n')
        print('| strategy | ' + ' | '.join(probe for probe, _ in columns) + ' |')
        print('| --- |' + ' ---: |' * len(columns))
        names = [s['name'] for s in columns[0][1]['strategies']]
        for name in names:
            row = []
            for _, result in columns:
                by_name = {s['name']: s for s in result['strategies']}
                here, base = cell(by_name[name], label), cell(by_name[BASE], label)
                if here.get('missed_light'):
                    row.append('light not found')
                    continue
                gain = base['relmse']['mean'] / here['relmse']['mean']
                bias = here['bias']
                sure = bias['low'] > 0 or bias['high'] < 0
                row.append(f"{short(gain)} / {short(here['efficiency']['mean'])}"
                           + (f" / {100 * bias['mean']:+.1f}" if sure else ''))
            print(f'| `{name}` | ' + ' | '.join(row) + ' |')


if __name__ == '__main__':
    main()
