from __future__ import annotations

from hypothesis import settings

# The same examples in every run: a failure in CI is one at the desk.
settings.register_profile("same", derandomize=True, database=None, deadline=None)
settings.load_profile("same")
