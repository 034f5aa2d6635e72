"""Trials by random wrong, odd, damaged and hostile input: no tracebacks, no endless work, no silent changes."""
