"""The program in plain English beside its code."""
