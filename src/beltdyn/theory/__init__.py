"""Closed forms and boundary-value problems of belt theory, for comparison with simulations."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        *("conveyor", "creep", "input_shaping", "nip", "observed_order", "rating", "running_drive", "span"),
        "static_tension",
    ],
)
