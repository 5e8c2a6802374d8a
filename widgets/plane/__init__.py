"""Where two axes are and have been, seen from above."""
