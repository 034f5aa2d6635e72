from beltdyn.report.statement import Finding, Number, Statement, Verdict, verdict


def statement(*findings: Finding) -> Statement:
    return Statement("name", "title", "quote", 250, "criterion", findings)


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
