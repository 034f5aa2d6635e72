"""Closed forms and boundary-value problems of belt theory, to hold simulations against; numbers in, numbers out."""
