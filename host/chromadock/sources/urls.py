"""What stands behind a URL: a live stream, or a video file on a server."""

from __future__ import annotations

import re
from functools import partial

from chromadock.controls.keeper import Keeper
from chromadock.sources.address import without_secrets
from chromadock.sources.base import OnFault, Source
from chromadock.sources.kept import kept
from chromadock.sources.live import Live
from chromadock.sources.stream import open_stream
from chromadock.sources.video_opening import open_remote_video

_SERVES_FILES = re.compile(r"(https?|ftps?|file):", re.IGNORECASE)


def open_url(
    url: str, on_fault: OnFault, tell: OnFault, delay_s: float, keeper: Keeper | None
) -> Source:
    """A network stream, or a video file behind a URL, which is one that has an end; ``keeper``: of
    the stream's camera.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    name = without_secrets(url)
    if _SERVES_FILES.match(url):
        video = open_remote_video(url, name, on_fault)
        if video.count is not None:
            return video
        video.close()
    return Live(kept(partial(open_stream, url, name), keeper), name, tell, delay_s)
