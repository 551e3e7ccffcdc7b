"""The colour decision: the same integers as the dock's C, in numpy and in ``host/native``.

Held to ``shared/vectors`` and to the compiled dockcore bit by bit
(``tests/parity``); the steps and their reasons are in ``docs/method.md``.
"""
