"""How one machine is configured."""
