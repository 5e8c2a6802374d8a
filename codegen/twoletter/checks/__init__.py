"""Checks of two-letter source: facts computed once, one function for each rule."""
