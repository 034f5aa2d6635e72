"""Motion over time: runs, run-ups, the simulator, checkpoints."""
