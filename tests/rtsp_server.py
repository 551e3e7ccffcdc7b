"""A real RTSP server on loopback, of GStreamer, whose pictures show when they were taken.

Run by the system's Python, which has GStreamer's bindings: ``python3 rtsp_server.py``.  It prints
its port.  Each picture shows the milliseconds of the monotonic clock, which all processes share,
as 32 black or white blocks: ``picture_time.py`` reads them.
"""

import sys
import threading
import time

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

WIDTH, HEIGHT, COLUMNS, ROWS, FPS = 320, 240, 8, 4, 30
PIPELINE = (
    f"( appsrc name=camera is-live=true format=time do-timestamp=true "
    f"caps=video/x-raw,format=GRAY8,width={WIDTH},height={HEIGHT},framerate={FPS}/1 "
    "! videoconvert ! video/x-raw,format=I420 "
    "! x264enc tune=zerolatency speed-preset=ultrafast key-int-max=15 bitrate=2000 "
    "! rtph264pay name=pay0 pt=96 config-interval=1 )"
)


def picture(milliseconds: int) -> bytes:
    """GRAY8 rows of blocks, the highest bit first."""
    bits = [255 * (milliseconds >> (31 - k) & 1) for k in range(32)]
    across, down = WIDTH // COLUMNS, HEIGHT // ROWS
    rows = []
    for row in range(ROWS):
        line = b"".join(bytes([bit]) * across for bit in bits[row * COLUMNS : (row + 1) * COLUMNS])
        rows.append(line * down)
    return b"".join(rows)


def push(camera: Gst.Element) -> None:
    """A picture each thirtieth of a second, until the client is gone."""
    due = time.monotonic()
    while True:
        taken = int(time.monotonic() * 1000) & 0xFFFFFFFF
        if camera.emit("push-buffer", Gst.Buffer.new_wrapped(picture(taken))) != Gst.FlowReturn.OK:
            return
        due += 1 / FPS
        time.sleep(max(0.0, due - time.monotonic()))


def configure(_factory: GstRtspServer.RTSPMediaFactory, media: GstRtspServer.RTSPMedia) -> None:
    """Start the camera of a client."""
    camera = media.get_element().get_by_name_recurse_up("camera")
    threading.Thread(target=push, args=(camera,), daemon=True).start()


Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_service(sys.argv[1] if len(sys.argv) > 1 else "0")
factory = GstRtspServer.RTSPMediaFactory()
factory.set_launch(PIPELINE)
factory.connect("media-configure", configure)
server.get_mount_points().add_factory("/camera", factory)
server.attach(None)
print(server.get_bound_port(), flush=True)
GLib.MainLoop().run()
