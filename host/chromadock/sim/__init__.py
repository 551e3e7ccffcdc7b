"""A simulator of underwater light, of the dock in it, and of the cameras that look at both."""
