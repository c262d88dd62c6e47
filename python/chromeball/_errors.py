# SPDX-License-Identifier: Apache-2.0
"""Errors and warnings."""

from ._core import set_errors


class InputError(ValueError):
    """What was given is wrong; the message says what would be right."""


class RunError(RuntimeError):
    """Something failed while it ran, such as a full disk, or was cancelled before it had rendered."""


class RenderWarning(UserWarning):
    """Something that may spoil an image: a clipped probe, invalid samples, too few bounces."""


for _class in (InputError, RunError, RenderWarning):
    _class.__module__ = "chromeball"
set_errors(InputError, RunError)
