"""Fits the network that weighs looks: one hidden layer, by logistic loss."""

from __future__ import annotations

import sys

import numpy as np
from step import ROOT

from chromadock._native import lib

# Where `tools/setup bench` puts scipy; .venv's own packages come first.
sys.path.append(str(ROOT / "build" / "bench"))
try:
    from scipy.optimize import minimize
except ImportError as error:
    sys.exit(f"{error}: tools/setup bench installs it")

RIDGE = 1.0
"""Of all squared weights, of a network in units of each input's standard deviation: none runs away
where classes part."""
STEPS = 800
"""Of L-BFGS, at most."""

Real = np.ndarray


class Network:
    """Weights (see ``front_network_t``) for inputs of mean ``mean`` and deviation ``scale``."""

    def __init__(self, inputs: Real) -> None:
        self._mean, self._scale = inputs.mean(axis=0), inputs.std(axis=0) + 1e-6
        count = inputs.shape[1]
        hidden = lib.FRONT_HIDDEN
        self._shapes = [(count, hidden), (hidden,), (hidden,), (count,), (1,)]
        self._cuts = np.cumsum([np.prod(shape) for shape in self._shapes])[:-1]
        rng = np.random.default_rng(0)
        first = rng.normal(0, 0.5 / np.sqrt(count), count * hidden)
        out = rng.normal(0, 0.5, hidden)
        self._all = np.concatenate([first, np.zeros(hidden), out, np.zeros(count), [-3.0]])

    def fit(self, inputs: Real, lamp: Real, worth: Real) -> None:
        """To (N, n) inputs of lamps and clutter, each of some worth."""
        z = ((inputs - self._mean) / self._scale).astype(np.float32)
        lamp, worth = lamp.astype(np.float32), worth.astype(np.float32)

        def loss(weights: Real) -> tuple[float, Real]:
            hidden, of_one, out, straight, one = self._split(weights.astype(np.float32))
            sums = z @ hidden + of_one
            damped = 1 / (1 + np.abs(sums))
            odds = (sums * damped) @ out + z @ straight + one
            value = (worth * (np.logaddexp(0, odds) - lamp * odds)).sum(dtype=np.float64)
            slope = worth * (1 / (1 + np.exp(-odds)) - lamp)
            back = slope[:, None] * out * damped**2
            parts = z.T @ back, back.sum(axis=0), slope @ (sums * damped), z.T @ slope
            gradient = np.concatenate([*(p.ravel() for p in parts), [slope.sum()]])
            ridge = np.append(weights[:-1], 0.0)
            return float(value + RIDGE / 2 * ridge @ ridge), gradient + RIDGE * ridge

        options = {"maxiter": STEPS, "maxcor": 20}
        self._all = minimize(loss, self._all, jac=True, method="L-BFGS-B", options=options).x

    def log_odds(self, inputs: Real) -> Real:
        """(N,) of a lamp."""
        weights = self.weights()
        sums = inputs @ weights["hidden"][:-1] + weights["hidden"][-1]
        straight = inputs @ weights["of_inputs"][:-1] + weights["of_inputs"][-1]
        return np.asarray(sums / (1 + np.abs(sums)) @ weights["of_hidden"] + straight)

    def weights(self) -> dict[str, Real]:
        """As ``front_network_t`` has them: of inputs as they are."""
        hidden, of_one, out, straight, one = self._split(self._all)
        hidden, straight = hidden / self._scale[:, None], straight / self._scale
        return {
            "hidden": np.vstack([hidden, of_one - self._mean @ hidden]),
            "of_hidden": out,
            "of_inputs": np.append(straight, one - self._mean @ straight),
        }

    def _split(self, weights: Real) -> list[Real]:
        parts = np.split(weights, self._cuts)
        return [part.reshape(shape) for part, shape in zip(parts, self._shapes, strict=True)]
