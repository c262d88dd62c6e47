# SPDX-License-Identifier: Apache-2.0
"""Steps of the tutorial, and the page as Markdown."""
import textwrap
from dataclasses import dataclass, field


@dataclass
class Step:
    title: str
    text: str
    commands: list = field(default_factory=list)
    said: str = ""  # what the program prints
    pictures: list = field(default_factory=list)  # (file name, what it shows)
    checks: list = field(default_factory=list)  # (what, found, truth, error)
    after: str = ""


def table(head, rows):
    def line(cells):
        return "| " + " | ".join(map(str, cells)) + " |"

    return "\n".join([line(head), "| --- |" + " ---: |" * (len(head) - 1), *map(line, rows)])


def some_lines(text, *beginnings):
    """The lines that begin so, in order."""
    return "\n".join(line for line in text.splitlines() if line.startswith(beginnings))


def step_text(number, step, folder):
    parts = [f"### {number}. {step.title}", step.text]
    if step.commands:
        parts.append("\n".join("    " + line for command in step.commands for line in command.split("\n")))
    if step.said:
        parts.append(f"```text\n{step.said}\n```")
    parts += [f"![{text}]({folder}/{name})\n\n{text}." for name, text in step.pictures]
    if step.checks:
        parts.append(table(["", "found", "truth", "error"], step.checks))
    if step.after:
        parts.append(step.after)
    return "\n\n".join(parts)


INTRODUCTION = """# From photographs to a composite

From a set, a person brings back

- photographs of a mirror ball from two sides, each in several exposures;
- a photograph of a grey ball and one of a white card beside the mirror ball, in several exposures;
- photographs of the place without the objects (the plate), in several exposures, and of a lamp for its lens;
- the measured positions of six or more points that the plate shows.

They get a light probe with its sun in the units of the plate, the plate's camera, and a composite in which objects
have the light, shadows, reflections and the lens of the plate.

The first part does this with photographs that chromeball renders itself, so that each step has a truth. The second
part does it with real photographs, of a student's course work, as far as they go.
`tools/scripts/capture_tutorial.sh` makes this page: it runs every command below and writes what it measures.
The theory is in [methods.md](methods.md#exposures-and-the-sun)."""


def page(place, steps, course, folder):
    parts = [INTRODUCTION, "## Part 1: photographs of known truth", place]
    parts += [step_text(i, step, folder) for i, step in enumerate(steps, 1)]
    rows = [(f"{i}. {step.title}", what, error)
            for i, step in enumerate(steps, 1) for what, _, _, error in step.checks]
    parts += ["### All errors", table(["step", "of what", "error"], rows), course]
    return "\n\n".join(map(wrapped, "\n\n".join(parts).split("\n\n"))) + "\n"


def wrapped(block):
    """A paragraph of text in lines; anything else as it is."""
    if block.startswith(("    ", "```", "|", "#", "!", "- ")):
        return block
    return textwrap.fill(block, 116, break_long_words=False, break_on_hyphens=False)
