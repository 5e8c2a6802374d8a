"""Two-letter code written by hand."""
