"""The paper's experiments, repeated on simulated frames, and their report."""
