"""The two-letter code as text."""
