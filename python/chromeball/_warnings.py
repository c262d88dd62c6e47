# SPDX-License-Identifier: Apache-2.0


class RenderWarning(UserWarning):
    """Something that may spoil an image: a clipped probe, invalid samples, an unreadable texture."""
