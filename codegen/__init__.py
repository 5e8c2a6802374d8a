"""Programs, instructions and controller languages: pure Python, no screen, no line, no clock."""
