"""The pages of the setup window."""
