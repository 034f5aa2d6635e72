import pytest

from validation.paper.statement import Finding, Number, Statement, Verdict, all_hold, clearly_below, verdict


def statement(*findings: Finding, published: int = 1) -> Statement:
    return Statement("name", "title", "quote", 250, "criterion", findings, published=published)


def finding(settings: str, holds: bool, *names: str) -> Finding:
    return Finding(settings, [Number(name, 1.0) for name in names], verdict(holds))


def test_the_first_finding_gives_the_verdict() -> None:
    agreed = statement(finding("as published", True), finding("better", True))
    contested = statement(finding("as published", True), finding("better", False))
    assert agreed.verdict is contested.verdict is Verdict.HOLDS
    assert (agreed.contested, contested.contested) == (False, True)


def test_findings_of_the_same_numbers_share_a_table() -> None:
    one, two, three = finding("a", True, "x", "y"), finding("b", False, "x", "y"), finding("c", True, "z")
    assert statement(one, two, three, finding("d", True)).tables == [[one, two], [three]]


@pytest.mark.parametrize(
    ("holds", "expected"),
    [((True, True), Verdict.HOLDS), ((False, False), Verdict.FAILS), ((True, False), Verdict.OPEN)],
)
def test_published_settings_that_disagree_leave_it_open(holds: tuple[bool, bool], expected: Verdict) -> None:
    """Another setting, which is not published, has no say."""
    five, eleven = (finding(f"{n} points", holding) for n, holding in zip((5, 11), holds, strict=True))
    assert statement(five, eleven, finding("better", True), published=2).verdict is expected


def test_one_part_that_fails_fails_all() -> None:
    holds, fails, is_open = Verdict.HOLDS, Verdict.FAILS, Verdict.OPEN
    assert all_hold([holds, is_open, fails]) is fails
    assert all_hold([holds, is_open]) is is_open
    assert all_hold([holds, holds]) is holds


@pytest.mark.parametrize(
    ("value", "expected"),
    [(0.0, Verdict.HOLDS), (0.79, Verdict.HOLDS), (0.81, Verdict.OPEN), (1.24, Verdict.OPEN), (1.26, Verdict.FAILS)],
)
def test_forces_near_a_limit_leave_it_open(value: float, expected: Verdict) -> None:
    assert clearly_below(value, 1.0) is expected
    opposite = {Verdict.HOLDS: Verdict.FAILS, Verdict.FAILS: Verdict.HOLDS, Verdict.OPEN: Verdict.OPEN}
    assert value == 0.0 or clearly_below(1.0, value) is opposite[expected]
