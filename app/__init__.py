"""Joins codegen, device and widgets into the studio and the command line."""
