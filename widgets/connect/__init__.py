"""Choosing what to work with: a serial line, the simulator, or nothing yet."""
