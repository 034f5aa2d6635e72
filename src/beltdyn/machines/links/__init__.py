"""The links of a hub chain, the couplings between the rim of a pulley and the bodies behind it."""
