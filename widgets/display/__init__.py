"""What the controller reports: positions, inputs, outputs, switches, threads, messages."""
