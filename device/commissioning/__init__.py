"""Bringing an axis to life: a list of steps, what was found in each, and the moves that some of them need."""
