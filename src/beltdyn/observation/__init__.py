"""From states to results: what is observed, recorded, and filtered."""
