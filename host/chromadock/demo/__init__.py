"""A closed loop without hardware: simple water, the real firmware core, the real detector."""
