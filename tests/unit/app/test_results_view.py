"""Analyses that the page offers, with their options."""

from urllib.parse import parse_qs, urlsplit

import pytest

from beltdyn.app.results_view import Option, mail_address, offered, options_of
from beltdyn.errors import ModelError


def test_analyses_are_offered_with_their_options() -> None:
    names = offered()
    assert {
        "simulate",
        "equilibrium",
        "steady_state",
        "traction",
        "modes",
        "campbell",
        "duty",
        "optimize",
    } <= names.keys()
    options = {one.name: one for one in options_of("campbell")}
    assert options["speed"].required
    assert options["points"] == Option("points", int, "40", False, "Number of speeds of a range.")
    assert [(one.name, one.kind) for one in options_of("equilibrium")] == [("force_tolerance", float)]
    assert {"from_", "to"} <= {one.name for one in options_of("sweep") if one.required}


def test_options_are_read_as_what_they_are() -> None:
    points = Option("points", int, "40", False, "")
    assert (points.read("12"), Option("slip", str, "", False, "").read("1")) == (12, "1")
    for wrong in ("1.5", "many"):
        with pytest.raises(ModelError, match="must be a whole number"):
            points.read(wrong)


def test_numbers_may_have_their_unit() -> None:
    at = next(one for one in options_of("steady_state") if one.name == "at")
    assert (at.read("0.5"), at.read("500 ms")) == (0.5, "500 ms")
    tolerance = next(one for one in options_of("steady_state") if one.name == "force_tolerance")
    assert tolerance.read("1 %") == "1 %"
    elements = next(one for one in options_of("steady_state") if one.name == "elements")
    with pytest.raises(ModelError, match=r"elements = 1 % must be a whole number"):
        elements.read("1 %")


def test_options_that_are_files_say_what_they_end_with() -> None:
    suffixes = {name: {one.name: one.suffixes for one in options_of(name)} for name in ("duty", "optimize", "response")}
    assert suffixes["duty"]["table"] == (".csv",)
    assert suffixes["optimize"]["study"] == (".toml",)
    assert suffixes["response"]["compare"] == (".nc",)
    assert suffixes["response"]["speed"] == ()


def test_every_option_says_what_it_means() -> None:
    for name in offered():
        for one in options_of(name):
            assert len(one.about) > 10, (name, one.name)
            assert "`" not in one.about


def test_a_mail_begins_with_subject_and_answer() -> None:
    address = urlsplit(mail_address("drive: modes", "slip & squeal: 50 %\nReport attached"))
    assert address.scheme == "mailto"
    assert parse_qs(address.query) == {"subject": ["drive: modes"], "body": ["slip & squeal: 50 %\r\nReport attached"]}
