"""The page on which a drive is laid out and run: a server on this machine, for a browser on this machine."""
