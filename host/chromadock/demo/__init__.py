"""A closed loop without hardware: simulated water, the real firmware core, the real detector."""
