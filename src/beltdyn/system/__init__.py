"""Belt and pulleys as arrays: assembly, joint constraint and linear solver, the paper's section 4."""
