"""Back-ups of a controller: the list, what is in one, how it compares, and the steps to replace a controller."""
