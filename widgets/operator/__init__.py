"""The operator terminal TERM-1500 at port 2, as a person sees and uses it."""
