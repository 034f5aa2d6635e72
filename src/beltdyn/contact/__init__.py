"""Contact between belt and pulleys: the paper's section 3, kernels only."""
