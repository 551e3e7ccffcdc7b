"""The static filters' tuning on frames of the simulator itself."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock.evaluate import tuning_frames
from chromadock.evaluate.experiment import MAX_SEED
from chromadock.evaluate.filters import filter_mask
from chromadock.evaluate.target import target_of
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.tuning_frames import tuned_filters, tuning_digest
from chromadock.evaluate.view import Vehicle
from chromadock.sim.scene import load_scene
from chromadock.sim.simulation import Simulation


@pytest.fixture(scope="module")
def tuned() -> Tuned:
    """On fewer frames than in an evaluation."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tuning_frames, "DISTANCES_M", (1.0, 2.0))
        patch.setattr(tuning_frames, "HEADINGS_DEG", (0.0, 90.0))
        return tuned_filters()


@pytest.mark.parametrize("water", ["pool", "lake"])
def test_a_static_filter_passes_markers_of_its_own_water_that_it_was_not_tuned_on(
    water: str, tuned: Tuned, record_property
) -> None:
    scene = load_scene(water, {"vehicle.distance_m": 1.0, "seed": 5})
    simulation = Simulation(scene)
    frame = simulation.frame(next(simulation.steps([0.0])))
    view = Vehicle().view(frame.image_bgr, 0.0)
    circles = target_of(scene, frame.truth).circles(frame.image_bgr.shape) > 0
    passed = {name: filter_mask(f"static {name}", view, tuned) > 0 for name in ("pool", "lake")}
    other = passed["lake" if water == "pool" else "pool"]
    own = passed[water]
    record_property(
        "figure",
        f"static filters tuned on 4 frames of the {water}, F1 {tuned.evidence[water]['f1']:.2f}: "
        f"{np.mean(own & circles):.5f} of the frame passed in the markers' circles, "
        f"{np.mean(own & ~circles):.5f} outside; the other one {np.mean(other & ~circles):.5f}",
    )
    assert tuned.evidence[water]["f1"] > 0.2
    assert np.count_nonzero(own & circles) > np.count_nonzero(other & circles)


def test_the_frames_are_none_of_an_experiments_and_their_code_is_in_the_digest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seeds = {scene.seed for name in tuning_frames.SCENES for scene in tuning_frames._scenes(name)}
    assert min(seeds) > MAX_SEED
    before = tuning_digest()
    assert tuning_digest() == before
    monkeypatch.setattr(tuning_frames, "code_digest", lambda: "other")
    assert tuning_digest() != before
