"""Opens video files, and URLs of such."""

from __future__ import annotations

from pathlib import Path

import av
from av.container import InputContainer
from av.video.stream import VideoStream

from chromadock.errors import ChromadockError
from chromadock.sources.base import OnFault
from chromadock.sources.container import lacks_index, missing_bytes, whole_boxes
from chromadock.sources.kinds import check_readable
from chromadock.sources.video import Video, nothing_left

_URL_TIMEOUT_S = 30.0


def open_video(path: Path, on_fault: OnFault, on_note: OnFault) -> Video:
    """Open a video file.

    Raises
    ------
    ChromadockError
        Where it is no video, so little of one that no frame can be read, or a picture of a kind
        that cannot be.
    """
    check_readable(path)
    missing = missing_bytes(path)
    container = None if _is_prose(path) else _open_file(path, missing)
    stream = None if container is None else _shown(container)
    if container is None or stream is None:
        if missing:  # an MP4 often has its index at its end
            raise nothing_left(str(path), missing)
        if lacks_index(path):
            raise ChromadockError(
                f"{path}: the recording was not finished, so its index (moov) is missing: rebuild "
                "it with untrunc, from a whole video of the same camera"
            )
        raise ChromadockError(
            f"{path}: cannot be read as a video or picture: check that it is one, and whole"
        )
    video = Video(container, stream, path.name, str(path), on_fault, on_note, missing)
    video.places = frozenset([path])
    return video


def open_remote_video(url: str, name: str, on_fault: OnFault) -> Video:
    """Open a video with an end behind a URL; messages have ``name`` in its place.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    try:
        container = _open(url, timeout=_URL_TIMEOUT_S)
    except av.FFmpegError as error:
        raise ChromadockError(
            f"{name}: does not open ({error.strerror}): check the address, and that it answers"
        ) from None
    stream = _shown(container)
    if stream is None:
        raise ChromadockError(f"{name}: has no picture that can be decoded: check the address")
    return Video(container, stream, name, name, on_fault)


def _open_file(path: Path, missing: int) -> InputContainer | None:
    # FFmpeg takes what stands before a colon for a protocol, but not in a whole path.
    places = [str(path.absolute())]
    if missing and (end := whole_boxes(path)):
        places.append(f"subfile,,start,0,end,{end},,:{places[0]}")
    for place in places:
        try:
            return _open(place)
        except av.FFmpegError:
            continue
    return None


def _open(place: str, timeout: float | None = None) -> InputContainer:
    # Cameras write their makers' names in any encoding.
    return av.open(place, "r", metadata_errors="replace", timeout=timeout)


def _shown(container: InputContainer) -> VideoStream | None:
    """The stream to look at; None, and the container closed, where none can be decoded."""
    stream = container.streams.best("video")
    if isinstance(stream, VideoStream) and stream.codec_context is not None:
        return stream
    container.close()
    return None


def _is_prose(path: Path) -> bool:
    """True for plain text, which FFmpeg would render as the film of a terminal; playlists
    and stream descriptions are text as well, but lead to a video."""
    with path.open("rb") as file:
        head = file.read(4096)
    if head.startswith((b"#EXTM3U", b"v=0")):
        return False
    try:
        text = head.decode("utf-8")
    except UnicodeDecodeError as error:
        if error.start < len(head) - 4:  # else only the last letter is cut
            return False
        text = head[: error.start].decode("utf-8")
    return all(letter.isprintable() or letter.isspace() for letter in text)
