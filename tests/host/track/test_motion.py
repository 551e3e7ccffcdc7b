from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from track_truth import rotation

from chromadock.track.motion import State, met
from chromadock.track.motion import rotation as turned

SMALL = st.floats(-1, 1)
VECTOR = st.tuples(SMALL, SMALL, SMALL).map(np.array)


def state(velocity: np.ndarray, turn_rate: np.ndarray) -> State:
    begun = met(rotation(5, 10), np.array([0.2, -0.1, 3.0]), np.diag([1e-4] * 3 + [1e-3] * 3))
    return State(begun.R, begun.t, velocity, turn_rate, begun.covariance)


@given(velocity=VECTOR, turn_rate=VECTOR, elapsed_s=st.floats(0, 2))
def test_a_dock_stands_in_the_world_while_the_camera_moves(
    velocity: np.ndarray, turn_rate: np.ndarray, elapsed_s: float
) -> None:
    before = state(velocity, turn_rate)
    after = before.after(elapsed_s)
    R_then_now = turned(turn_rate * elapsed_s)  # of the camera
    np.testing.assert_allclose(R_then_now @ after.R, before.R, atol=1e-9)
    np.testing.assert_allclose(
        R_then_now @ after.t, before.t + velocity * elapsed_s, atol=1e-9
    )  # the camera stands for what it moves by
    np.testing.assert_allclose(after.R @ after.R.T, np.eye(3), atol=1e-9)


@given(velocity=VECTOR, turn_rate=VECTOR, elapsed_s=st.floats(0, 3))
def test_the_covariance_stays_one_and_grows(
    velocity: np.ndarray, turn_rate: np.ndarray, elapsed_s: float
) -> None:
    before = state(velocity, turn_rate)
    after = before.after(elapsed_s)
    assert np.linalg.eigvalsh(after.covariance).min() > -1e-12
    assert np.linalg.slogdet(after.covariance)[1] >= np.linalg.slogdet(before.covariance)[1] - 1e-6


def test_small_errors_are_carried_on_as_the_covariance_says() -> None:
    """Without noise: the spread of many starts, moved one by one."""
    rng = np.random.default_rng(0)
    begun = state(np.array([0.1, 0.0, -0.5]), np.array([0.0, 0.1, 0.05]))
    spread = np.diag(np.repeat([0.01, 0.01, 0.02, 0.01], 3)) ** 2
    begun = State(begun.R, begun.t, begun.velocity, begun.turn_rate, spread)
    middle = begun.after(0.8)
    ends = []
    for step in rng.multivariate_normal(np.zeros(12), spread, 4000):
        end = begun.corrected(step, spread).after(0.8)
        turn = end.R @ middle.R.T
        vector = np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        ends.append(np.concatenate([
            end.t - middle.t, vector / 2, end.velocity - middle.velocity,
            end.turn_rate - middle.turn_rate,
        ]))  # fmt: skip
    found = np.cov(np.array(ends).T)
    still = State(begun.R, begun.t, begun.velocity, begun.turn_rate, np.zeros((12, 12)))
    expected = middle.covariance - still.after(0.8).covariance
    np.testing.assert_allclose(np.diag(found), np.diag(expected), rtol=0.1)
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs(found - expected).max() / scale.max() < 0.1
    np.testing.assert_allclose(found / scale, expected / scale, atol=0.08)


def test_two_steps_are_as_uncertain_as_one_of_the_same_length() -> None:
    begun = state(np.zeros(3), np.zeros(3))
    one, two = begun.after(0.6), begun.after(0.2).after(0.4)
    np.testing.assert_allclose(two.covariance, one.covariance, rtol=0.05, atol=1e-6)
    assert two.t == pytest.approx(one.t)
