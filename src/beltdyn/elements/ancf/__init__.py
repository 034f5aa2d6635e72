"""The belt element of the absolute nodal coordinate formulation: the paper's section 2, kernels only."""
