"""The belt at rest in its drive, on both meshes."""
