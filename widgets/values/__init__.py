"""Variables and arrays of the controller."""
