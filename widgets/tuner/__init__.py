"""The tuner: gains, steps, automatic and model-based tuning, and the logbook."""
