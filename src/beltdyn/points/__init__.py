"""Many operating points of a drive: map, traction, duty, tensioner sheet."""
