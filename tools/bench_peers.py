"""What others' blob and marker detectors cost on the same frame."""

from __future__ import annotations

import sys
from collections.abc import Callable

import cv2
import numpy as np
from bench_ratios import one_thread, ratio
from step import ROOT

from chromadock import Detector, DockGeometry

# Where tools/setup puts the packages of requirements-bench.txt; .venv's own come first.
PACKAGES = ROOT / "build" / "bench"

ROUNDS = 9
BLOB_SIGMAS = {"min_sigma": 1, "max_sigma": 16, "num_sigma": 9, "log_scale": True}
"""Of ``blob_log``: half an octave apart over the sizes of markers from 7 m to 0.5 m."""

SETTINGS = {
    "SimpleBlobDetector": "the detector's mask, light blobs, minArea 4, else its defaults",
    "blob_log": "scikit-image on the grey frame, nine sigmas from 1 to 16 px",
    "pupil-apriltags": "tag36h11 on the grey frame, one thread, else its defaults",
}
"""What each is run on, by its name."""


def peer_ratios(frame_bgr: np.ndarray, rounds: int = ROUNDS) -> tuple[dict[str, float], list[str]]:
    """Time each against one Gaussian blur of the frame.

    Returns
    -------
    Ratios by name, and a line for each that is not installed.
    """
    if str(PACKAGES) not in sys.path:
        sys.path.append(str(PACKAGES))
    makers = {
        "SimpleBlobDetector": simple_blob_detector,
        "blob_log": blob_log,
        "pupil-apriltags": apriltags,
    }
    ratios, skipped = {}, []
    with one_thread():
        for name, make in makers.items():
            try:
                work = make(frame_bgr)
            except ImportError as error:
                skipped.append(
                    f"{name}: {error}: tools/setup bench installs it where it can be had"
                )
                continue
            ratios[name] = ratio(frame_bgr, work, rounds)
    return ratios, skipped


def simple_blob_detector(frame_bgr: np.ndarray) -> Callable[[], object]:
    """OpenCV's, on the mask that the robust method makes of the frame."""
    mask = mask_of(frame_bgr)
    settings = cv2.SimpleBlobDetector_Params()
    settings.blobColor = 255
    settings.minArea = 4
    peer = cv2.SimpleBlobDetector_create(settings)
    return lambda: peer.detect(mask)


def mask_of(frame_bgr: np.ndarray) -> np.ndarray:
    """(H, W) uint8: 255 where the frame stands out in the markers' colour, else 0."""
    detector = Detector(None, DockGeometry.default(), independent=True)
    detector.process(frame_bgr, 0.0)
    return detector.mask.astype(np.uint8) * 255


def blob_log(frame_bgr: np.ndarray) -> Callable[[], object]:
    """scikit-image's Laplacian of Gaussian."""
    from skimage.feature import blob_log

    grey = cv2.cvtColor(frame_bgr, cv2.COLOR_BGR2GRAY).astype(np.float32) / 255
    return lambda: blob_log(grey, **BLOB_SIGMAS)


def apriltags(frame_bgr: np.ndarray) -> Callable[[], object]:
    """The usual alternative to lights: printed squares."""
    import pupil_apriltags

    peer = pupil_apriltags.Detector(families="tag36h11", nthreads=1)
    grey = cv2.cvtColor(frame_bgr, cv2.COLOR_BGR2GRAY)
    return lambda: peer.detect(grey)
