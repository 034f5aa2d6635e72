"""A belt as a chain of straight links: truss elements, and beams of links with torsional springs; kernels only.

The models that the paper compares itself with: truss elements of Leamy and Wasfy, and their three-node beam elements,
which use the places of nodes as unknowns and nothing else.
"""
