"""Qt views of programs and live controllers; signals go up, calls come down."""
