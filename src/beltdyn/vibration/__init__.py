"""Small vibrations about a state: modes, Campbell diagram, forced response."""
