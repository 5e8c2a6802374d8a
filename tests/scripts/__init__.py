"""Transcripts of whole sessions with a simulated controller."""
