"""From states to results: what is seen at the states of a simulation, and how it is recorded."""
