"""The simulated two-letter controller: wire, memory, threads and what each command does."""
