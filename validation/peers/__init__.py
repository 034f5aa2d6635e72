"""The same drives in other codes."""
