"""What happened at the machine, as a list that can be searched."""
