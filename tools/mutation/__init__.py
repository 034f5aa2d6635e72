"""Mutation testing: count the small changes of the sources that a test notices."""
