"""The simulated motion controllers: bytes in, bytes out, on simulated time."""
