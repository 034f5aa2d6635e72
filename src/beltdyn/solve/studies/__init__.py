"""Studies: many designs of a drive, their results by name, and the search among them."""
