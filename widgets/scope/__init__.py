"""Captures, live roll, cursors, measurements, spectra."""
