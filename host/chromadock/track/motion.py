"""How the dock moves in the camera frame: a rigid world before a camera that moves.

The dock stands, up to its bobbing; the camera moves with a velocity and turns with a rate that
both change by white acceleration (Bar-Shalom, Li, Kirubarajan, Estimation with Applications to
Tracking and Navigation, 2001, section 6.2.2).  Turning moves the dock's place in the camera frame
along with its attitude, so what bearings tell of the turn holds for the attitude too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import lever

Floats = NDArray[np.float64]

ACCELERATION = 0.3
"""Of the vehicle against the dock, m/s^2 per root Hz: its speed is uncertain by so many m/s after
one second.  A vehicle of 1 m/s stops within 2 s (0.5 m/s^2); waves of 3 s period that move it
by 0.1 m accelerate it by 0.4 m/s^2."""

TURNING = 0.3
"""The same of the camera's rate of turn, rad/s^2 per root Hz: waves of 3 s that turn a small
vehicle by 5 degrees accelerate it by 0.4 rad/s^2."""

SWIFT_ACCELERATION = 1.0
"""The first of a vehicle that manoeuvres: it stops from 1 m/s within a second."""

SWIFT_TURNING = 2.0
"""The second: a vehicle that swings by 15 degrees to either side within 1.5 s, at up to 63 degrees
a second, changes its rate by 1.1 rad/s within 0.4 s."""

DOCK_TURNING = 0.03
"""How the dock itself turns, rad per root s: 1.7 degrees in a second, a dock that bobs by a
few degrees within some seconds.  Less, and motion tells the two planar poses apart sooner."""

SPEED = 1.0
"""Of a vehicle that has just been met, m/s along each axis, standard deviation."""

TURN_RATE = 0.3
"""The same of its rate of turn, rad/s: 17 degrees a second."""

POSE = slice(0, 6)
ATTITUDE = slice(3, 6)
RATE = slice(9, 12)
"""Parts of a state's errors."""

_EYE = np.eye(3)


@dataclass(frozen=True, eq=False, slots=True)
class State:
    """Where the dock is, and how the camera moves, at one moment.

    ``R`` (3, 3), ``t`` (3,) metres: ``T_camera_dock``.  ``velocity`` (3,) m/s: of the dock as
    seen by a camera that does not turn.  ``turn_rate`` (3,) rad/s: of the camera; both in
    camera axes.  ``covariance`` (12, 12) of the errors of t, of small turns of the dock about
    the camera's axes (as in ``pose.Estimate``), of velocity and turn rate.  ``drawn`` (12,): by how
    much all of these are off if what may be wrong with all markers together, in every frame alike,
    is as wrong as one standard deviation.  No number of frames makes that less, so it is carried
    along beside the filter and not in its covariance: a parameter that is considered and not
    estimated (Schmidt; Jazwinski, Stochastic Processes and Filtering Theory, 1970, section 8.4).
    """

    R: Floats
    t: Floats
    velocity: Floats
    turn_rate: Floats
    covariance: Floats
    drawn: Floats = field(default_factory=lambda: np.zeros(12))

    @property
    def as_told(self) -> State:
        """The same with all that may be wrong in its covariance: for the user, and for doubt."""
        return replace(self, covariance=self.covariance + np.outer(self.drawn, self.drawn))

    def corrected(self, step: Floats, covariance: Floats) -> State:
        """With errors (12,) taken off."""
        return State(
            rotation(step[3:6]) @ self.R,
            self.t + step[:3],
            self.velocity + step[6:9],
            self.turn_rate + step[9:],
            (covariance + covariance.T) / 2,
            self.drawn,
        )

    def moved_to(self, R: Floats, t: Floats, pose_covariance: Floats) -> State:
        """The same motion at another pose, of which it tells nothing."""
        covariance = self.covariance.copy()
        covariance[POSE, 6:] = covariance[6:, POSE] = 0.0
        covariance[POSE, POSE] = pose_covariance
        drawn = self.drawn.copy()
        # What may be wrong with a frame's pose is in its own covariance.
        drawn[POSE] = 0.0
        return State(R, t, self.velocity, self.turn_rate, covariance, drawn)

    def strayed(self, variance: float) -> State:
        """With a turn rate that has changed meanwhile, each of its numbers with ``variance``."""
        covariance = self.covariance.copy()
        covariance[RATE, RATE] += variance * np.eye(3)
        return replace(self, covariance=covariance)

    def about(self, origin: Floats) -> State:
        """The same dock by a frame with its origin at ``origin`` (3,), metres, dock frame.

        As a rigid body that stands it moves everywhere alike: only place and its errors change.
        """
        arm = self.R @ origin
        J = np.eye(12)
        J[POSE, POSE] = lever(arm)
        covariance = J @ self.covariance @ J.T
        symmetric = (covariance + covariance.T) / 2
        return State(self.R, self.t + arm, self.velocity, self.turn_rate, symmetric, J @ self.drawn)

    def after(self, elapsed_s: float, swift: float = 0.0) -> State:
        """The state ``elapsed_s`` >= 0 later, nothing seen meanwhile.

        ``swift`` 0..1: probability that the vehicle manoeuvres; between 0 and 1 the errors have
        the covariance of both possibilities together.
        """
        if elapsed_s == 0:
            return self
        turned = rotation(-self.turn_rate * elapsed_s)
        t = turned @ (self.t + self.velocity * elapsed_s)
        velocity = turned @ self.velocity
        of_turning = _of_turning(t, velocity)
        F = np.zeros((12, 12))
        F[:3, :3] = F[3:6, 3:6] = F[6:9, 6:9] = turned
        F[:3, 6:9] = turned * elapsed_s
        F[:, 9:] = of_turning * elapsed_s
        F[9:, 9:] = _EYE
        covariance = F @ self.covariance @ F.T + _noise(of_turning, elapsed_s, swift)
        symmetric = (covariance + covariance.T) / 2
        return State(turned @ self.R, t, velocity, self.turn_rate, symmetric, F @ self.drawn)


def met(R: Floats, t: Floats, covariance: Floats) -> State:
    """The state of a dock seen for the first time, its pose known to (6, 6) ``covariance``."""
    full = np.diag(np.repeat([0.0, 0.0, SPEED**2, TURN_RATE**2], 3))
    full[POSE, POSE] = covariance
    return State(R, t, np.zeros(3), np.zeros(3), full)


def rotation(vector: Floats) -> Floats:
    """(3, 3) of a rotation vector (3,), radians."""
    return np.asarray(cv2.Rodrigues(vector)[0], np.float64)


def turn_between(R_from: Floats, R_to: Floats) -> Floats:
    """(3,) rotation vector about the camera's axes that takes one attitude to the other."""
    return np.asarray(cv2.Rodrigues(R_to @ R_from.T)[0], np.float64).ravel()


def cross_matrix(v: Floats) -> Floats:
    """(3, 3) with ``cross_matrix(v) @ w = v x w``."""
    x, y, z = v.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _of_turning(t: Floats, velocity: Floats) -> Floats:
    """(12, 3) what a turn of the camera does to t, the dock's attitude and velocity."""
    return np.concatenate([cross_matrix(t), -_EYE, cross_matrix(velocity), np.zeros((3, 3))])


def acceleration_of(swift: float) -> float:
    """m/s^2 per root Hz, of a vehicle that manoeuvres with probability ``swift``."""
    return math.sqrt((1 - swift) * ACCELERATION**2 + swift * SWIFT_ACCELERATION**2)


def turning_of(swift: float) -> float:
    """rad/s^2 per root Hz, of a vehicle that manoeuvres with probability ``swift``."""
    return math.sqrt((1 - swift) * TURNING**2 + swift * SWIFT_TURNING**2)


def _noise(of_turning: Floats, elapsed_s: float, swift: float) -> Floats:
    """(12, 12) what accelerations add meanwhile: integral of G(s) G(s)^T, G(s) = s A + B."""
    A, B = np.zeros((12, 6)), np.zeros((12, 6))
    acceleration, turning = acceleration_of(swift), turning_of(swift)
    A[:3, :3] = B[6:9, :3] = acceleration * _EYE
    A[:, 3:] = turning * of_turning
    B[9:, 3:] = turning * _EYE
    mixed = A @ B.T
    noise = A @ A.T * (elapsed_s**3 / 3) + (mixed + mixed.T) * (elapsed_s**2 / 2)
    noise += B @ B.T * elapsed_s
    noise[3:6, 3:6] += DOCK_TURNING**2 * elapsed_s * _EYE
    return np.asarray(noise)
