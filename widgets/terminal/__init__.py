"""Typed commands, replies and the prompt of a waiting program."""
