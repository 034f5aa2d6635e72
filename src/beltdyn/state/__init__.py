"""States of a drive: rest, and steady running."""
