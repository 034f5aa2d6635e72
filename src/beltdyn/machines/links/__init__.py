"""The links of a hub chain: what couples the rim of a pulley with the bodies behind it."""
