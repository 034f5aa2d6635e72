"""Time integrators: generalised-alpha in compiled code, standard ones, and what their users put together."""
