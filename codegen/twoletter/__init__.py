"""The two-letter language of the SSC and the DMC-141x: table, parser, evaluator, formatter, checks, emitters."""
