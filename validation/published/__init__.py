"""The paper's cases by name, with its published settings: laid start, fixed Gauss points, Eq. 17 as printed."""

from validation.published.cases import (
    CASES,
    RISE,
    Case,
    better,
    demo_text,
    loaded_case_1,
    loaded_two_pulley,
    three_pulleys,
    two_pulley,
    unequal_pulleys,
)

__all__ = [
    "CASES",
    "RISE",
    "Case",
    "better",
    "demo_text",
    "loaded_case_1",
    "loaded_two_pulley",
    "three_pulleys",
    "two_pulley",
    "unequal_pulleys",
]
