"""Teaching by hand: the table, its stick, its picture."""
