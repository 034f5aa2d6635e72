"""The browser page for editing and simulating a drive, served on this machine only."""
