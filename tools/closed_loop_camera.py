"""An RTSP camera that shows rendered frames, of GStreamer, in real time.

Run by the system's Python, which has GStreamer's bindings: ``python3 closed_loop_camera.py FOLDER
WIDTH HEIGHT FPS``.  The folder has ``lit.bgr`` and ``dark.bgr``, the same frames one after the
other with the dock's lights on and off; they are shown forth and back for ever, those that the last
line of standard input names.  It prints its port, then a line a picture: milliseconds of the
monotonic clock, which all processes share, the frame's number, and which of the two.
"""

import sys
import threading
import time
from pathlib import Path

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

FOLDER, (WIDTH, HEIGHT, FPS) = Path(sys.argv[1]), map(int, sys.argv[2:5])
SIZE = WIDTH * HEIGHT * 3
FILMS = {name: (FOLDER / f"{name}.bgr").read_bytes() for name in ("lit", "dark")}
COUNT = len(FILMS["lit"]) // SIZE
PIPELINE = (
    f"( appsrc name=camera is-live=true format=time do-timestamp=true "
    f"caps=video/x-raw,format=BGR,width={WIDTH},height={HEIGHT},framerate={FPS}/1 "
    "! videoconvert ! video/x-raw,format=I420 "
    f"! x264enc tune=zerolatency speed-preset=ultrafast key-int-max={FPS} bitrate=6000 "
    "! rtph264pay name=pay0 pt=96 config-interval=1 )"
)
shown = "lit"


def forth_and_back(number: int) -> int:
    """0, 1 .. COUNT-1, COUNT-2 .. 0, 1 and so on."""
    place = number % (2 * COUNT - 2)
    return min(place, 2 * COUNT - 2 - place)


def push(camera: Gst.Element) -> None:
    """A picture each period, until the client is gone."""
    due, number = time.monotonic(), 0
    while True:
        which, frame = shown, forth_and_back(number)
        taken_ms = 1000 * time.monotonic()
        picture = FILMS[which][frame * SIZE : (frame + 1) * SIZE]
        if camera.emit("push-buffer", Gst.Buffer.new_wrapped(picture)) != Gst.FlowReturn.OK:
            return
        print(f"{taken_ms:.1f} {frame} {which}", flush=True)
        number += 1
        due += 1 / FPS
        time.sleep(max(0.0, due - time.monotonic()))


def configure(_factory: GstRtspServer.RTSPMediaFactory, media: GstRtspServer.RTSPMedia) -> None:
    """Start the camera of a client."""
    camera = media.get_element().get_by_name_recurse_up("camera")
    threading.Thread(target=push, args=(camera,), daemon=True).start()


def listen() -> None:
    """Take what is to be shown from standard input."""
    global shown
    for line in sys.stdin:
        shown = line.strip()


Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_service("0")
factory = GstRtspServer.RTSPMediaFactory()
factory.set_launch(PIPELINE)
factory.connect("media-configure", configure)
server.get_mount_points().add_factory("/camera", factory)
server.attach(None)
print(server.get_bound_port(), flush=True)
threading.Thread(target=listen, daemon=True).start()
GLib.MainLoop().run()
