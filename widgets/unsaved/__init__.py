"""Unsaved work that was left behind."""
