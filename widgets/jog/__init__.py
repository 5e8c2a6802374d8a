"""Moving a machine by hand."""
