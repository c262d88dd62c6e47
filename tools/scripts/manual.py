#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/chromeball.1 and the completion files of tools/completion/ from the --help of
build/chromeball, or of another executable: manual.py [COMMAND]. Run it after a change to a command
or an option; a test compares the names."""
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'build/chromeball'
SPDX = 'SPDX-License-Identifier: Apache-2.0'
WRITTEN = 'Written by tools/scripts/manual.py; edits are lost.'


@dataclass
class Entry:
    """One line of --help: an option, a positional argument or a subcommand."""
    names: list
    argument: str  # 'FILE', '' for flags, '[=PORT]' if it may be left out
    notes: str     # 'REQUIRED', 'Excludes: ...'
    description: str = ''

    def needs_argument(self):
        return self.argument != '' and not self.argument.startswith('[')

    def choices(self):
        """The names that the description ends with: '... off, balance, power. [balance]'."""
        found = re.search(r'(?:^|[.:;] )([\w-]+(?:, [\w-]+)+)\. \[[^\]]*\]$', self.description)
        return found[1].split(', ') if found and self.argument.startswith('NAME') else []


@dataclass
class Command:
    words: list  # ['probe', 'info']
    about: str
    sections: list = field(default_factory=list)  # (title, [Entry])
    children: list = field(default_factory=list)
    footer: str = ''

    def options(self):
        return [e for _, entries in self.sections for e in entries if e.names[0].startswith('-')]


def parse_entry(text):
    names, _, rest = text.partition(' ')
    match = re.match(r'((?!REQUIRED|Excludes:|Needs:)\S+(?: \.\.\.)?)? ?(.*)', rest)
    return Entry(names.split(','), match[1] or '', match[2])


def read_help(words):
    """The command's whole --help, with those of its subcommands below it."""
    lines = subprocess.run([COMMAND, *words, '--help', 'all'], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    usage = next(i for i, line in enumerate(lines) if line.startswith('Usage:'))
    command = Command(words, ' '.join(line.strip() for line in lines[:usage]).strip())
    for line in lines[usage + 1:]:
        entry = re.match(r'  (\S.*?)(?:\s{2,}(\S.*))?$', line)
        if re.match(r'\S.*:$', line):
            command.sections.append((line[:-1], []))
        elif entry:
            command.sections[-1][1].append(parse_entry(entry[1]))
            command.sections[-1][1][-1].description = entry[2] or ''
        elif line[:1].strip():
            command.footer = f'{command.footer} {line.strip()}'.strip()
        elif line.strip():  # a description goes on
            last = command.sections[-1][1][-1]
            last.description = f'{last.description} {line.strip()}'.strip()
    for title, entries in command.sections:
        if title == 'Subcommands':
            command.children = [read_help(words + e.names) for e in entries]
    return command


def all_commands(command):
    return [c for child in command.children for c in [child, *all_commands(child)]]


def sentence(text):
    text = text.rstrip('.')
    starts_with_names = re.match(r'[\w:-]+,', text)  # "auto, lat-long, ..."
    return text if starts_with_names else text[:1].upper() + text[1:]


def paragraph(text):
    return sentence(text) + ('' if text.endswith(']') else '.')


# The man page

MAN_HEAD = r'''.\" {spdx}
.\" {written}
.TH CHROMEBALL 1 "" "{version}" "User Commands"
.SH NAME
chromeball \- render glTF scenes lit by HDR light probes
.SH SYNOPSIS
.B chromeball
.I command
.RI [ options ]
.SH DESCRIPTION
.B chromeball
is an offline path tracer for glTF scenes lit by HDR light probes. It samples a probe by one of many
strategies, estimates how noisy the image is, compares strategies, and composites rendered objects
onto photographs. A scene is a scene file (.toml) or a model (.gltf, .glb).
.SH EXAMPLES
.TP
.B chromeball render helmet.gltf \-\-probe studio.hdr \-o helmet.exr \-o helmet.png
Render a model lit by a probe, as radiance and tone mapped.
.TP
.B chromeball render scene.toml \-\-noise 2
Render a scene file until the noise is 2%.
.TP
.B chromeball probe info studio.hdr
Print the mapping, dynamic range and suns of a probe.
'''

MAN_TAIL = r'''.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Something failed while running, for example a full disk.
.TP
.B 2
The arguments or an input file are wrong; one line on standard error says where, and what would be
right.
.TP
.B 130
Interrupted; the image so far is saved.
'''


def man(text):
    text = text.replace('\\', r'\e').replace('-', r'\-')
    return r'\&' + text if text[:1] in ".'" else text


def man_entry(entry):
    names = ', '.join(rf'\fB{man(name)}\fR' for name in entry.names)
    space = ' ' if entry.needs_argument() else ''
    argument = rf'{space}\fI{man(entry.argument)}\fR' if entry.argument else ''
    notes = f' ({man(entry.notes.lower())})' if entry.notes else ''
    return f'.TP\n{names}{argument}{notes}\n{man(paragraph(entry.description))}\n'


def man_page(program, version):
    text = MAN_HEAD.format(spdx=SPDX, written=WRITTEN, version=version)
    text += '.SH OPTIONS\n' + ''.join(man_entry(e) for e in program.options())
    text += '.SH COMMANDS\n'
    for command in all_commands(program):
        if command.children:
            continue
        positionals = [e for title, entries in command.sections if title == 'Positionals'
                       for e in entries]
        words = ' '.join(['chromeball', *command.words, *(e.names[0].upper() for e in positionals)])
        text += f'.SS {man(words)}\n{man(sentence(command.about))}.\n'
        for title, entries in command.sections:
            entries = [e for e in entries if '--help' not in e.names]
            if entries and title not in ('Positionals', 'Options'):
                text += f'.PP\n\\fI{man(title)}\\fR\n'
            text += ''.join(man_entry(e) for e in entries)
        text += f'.PP\n{man(command.footer)}\n' if command.footer else ''
    return text + MAN_TAIL


# Completion

def long_names(command):
    return [n for e in command.options() for n in e.names if n.startswith('--')]


def bash_values(program):
    return ''.join(f"    '{' '.join([*command.words, name])}') words='{' '.join(e.choices())}' ;;\n"
                   for command in all_commands(program) for e in command.options() if e.choices()
                   for name in e.names)


def bash_completion(program):
    cases = ''
    for command in [program, *all_commands(program)]:
        cases += f"    '{' '.join(command.words)}')\n"
        if command.children:
            cases += f"      words='{' '.join(c.words[-1] for c in command.children)}'\n"
        cases += f"      options='{' '.join(long_names(command))}' ;;\n"
    groups = '|'.join(c.words[-1] for c in program.children if c.children)
    return f'''# {SPDX}
# {WRITTEN}
_chromeball() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command='' words='' options=''
  ((COMP_CWORD > 1)) && command=${{COMP_WORDS[1]}}
  case $command in
    {groups}) ((COMP_CWORD > 2)) && command+=" ${{COMP_WORDS[2]}}" ;;
  esac
  case $command in
{cases}  esac
  case "$command $previous" in
{bash_values(program)}  esac
  [[ $current == -* ]] && words=$options
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
# File names where there is nothing else to offer.
complete -o default -F _chromeball chromeball
'''


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_arguments(command):
    lines = []
    for entry in command.options():
        about = re.sub(r'([\[\]:\\])', r'\\\1', sentence(entry.description))
        values = f"({' '.join(entry.choices())})" if entry.choices() else '_files'
        value = f':value:{values}' if entry.needs_argument() else ''
        repeated = '*' if '...' in entry.argument else ''
        lines += [quoted(f'{repeated}{name}[{about}]{value}') for name in entry.names]
    return ' \\\n        '.join(['_arguments', *lines, "'*:file:_files'"])


def zsh_describe(command):
    words = [quoted(f"{c.words[-1]}:{sentence(c.about)}") for c in command.children]
    return ('commands=(' + '\n        '.join(words) + ')\n      _describe command commands\n      '
            '_arguments ' + ' '.join(quoted(name) for name in long_names(command)))


def zsh_completion(program):
    cases = ''
    for command in all_commands(program):
        if not command.children:
            cases += f"    {quoted(' '.join(command.words))})\n      {zsh_arguments(command)} ;;\n"
        else:
            cases += f"    {quoted(' '.join(command.words))})\n      {zsh_describe(command)} ;;\n"
    groups = '|'.join(c.words[-1] for c in program.children if c.children)
    return f'''#compdef chromeball
# {SPDX}
# {WRITTEN}
_chromeball() {{
  local command
  local -a commands
  if ((CURRENT > 2)); then
    command=$words[2]
    shift words
    ((CURRENT--))
    if [[ $command == ({groups}) ]] && ((CURRENT > 2)); then
      command+=" $words[2]"
      shift words
      ((CURRENT--))
    fi
  fi
  case $command in
    '')
      {zsh_describe(program)} ;;
{cases}  esac
}}
_chromeball "$@"
'''


def fish_completion(program):
    lines = [f'# {SPDX}', f'# {WRITTEN}']
    for command in [program, *all_commands(program)]:
        seen = '; and '.join(f'__fish_seen_subcommand_from {word}' for word in command.words)
        children = [c.words[-1] for c in command.children]
        condition = seen or '__fish_use_subcommand'
        if seen and children:
            condition += f"; and not __fish_seen_subcommand_from {' '.join(children)}"
        start = f'complete -c chromeball -n {quoted(condition)}'
        lines += [f'{start} -f -a {c.words[-1]} -d {quoted(sentence(c.about))}'
                  for c in command.children]
        for entry in command.options():
            names = ' '.join(f'-l {n[2:]}' if n.startswith('--') else f'-s {n[1:]}'
                             for n in entry.names)
            value = ' -r' if entry.needs_argument() else ''
            if entry.choices():
                value = f" -x -a {quoted(' '.join(entry.choices()))}"
            lines.append(f'{start} {names}{value} -d {quoted(sentence(entry.description))}')
    return '\n'.join(lines) + '\n'


def main():
    version = subprocess.run([COMMAND, '--version'], check=True, capture_output=True,
                             text=True).stdout.strip()
    program = read_help([])
    completion = ROOT / 'tools/completion'
    completion.mkdir(exist_ok=True)
    (ROOT / 'docs').mkdir(exist_ok=True)
    (ROOT / 'docs/chromeball.1').write_text(man_page(program, version))
    (completion / 'chromeball.bash').write_text(bash_completion(program))
    (completion / '_chromeball').write_text(zsh_completion(program))
    (completion / 'chromeball.fish').write_text(fish_completion(program))


main()
