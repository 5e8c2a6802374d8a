"""The window that brings an axis to life."""
