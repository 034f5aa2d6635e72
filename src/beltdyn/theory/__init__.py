"""Closed forms and boundary-value problems of belt theory, for comparison with simulations."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        "belt_rating",
        "capstan",
        "creep",
        "elastic_creep",
        "hoop",
        "hysteresis",
        "nip",
        "path",
        "running_drive",
        "sliding_flutter",
        "span",
        "static_tension",
        "tooth_rating",
    ],
)
