"""The world outside the simulated controller: switches, inputs, voltages, a push."""
