"""Where results come from, and in what drives differ."""

import hashlib
from pathlib import Path

from beltdyn.results import Run, open_run
from beltdyn.results.provenance import mesh_used
from beltdyn.show.plot.headline import differing_keys
from beltdyn.show.report.report import origin, write_report


def test_the_origin_names_versions_hashes_and_settings(run: Run, tmp_path: Path) -> None:
    meshed = Run(run.dataset.assign_attrs(mesh_used(run.drive, run.drive.frame, 20)), run.drive)
    path = meshed.save(tmp_path / "run.nc")
    facts = dict(origin(open_run(path)))
    assert facts["SHA-256 of run.nc"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert facts["SHA-256 of the drive"] == hashlib.sha256(run.drive.text.encode()).hexdigest()
    assert facts["versions"].startswith("beltdyn 0.")
    assert facts["integrator"] == "generalized_alpha, rtol 0.0001, start laid"
    assert facts["mesh"] == "20 ancf elements, travelling, as given"


def test_differences_name_keys_and_values(run: Run) -> None:
    other = Run(run.dataset, run.drive.with_({"pulley[driven].inertia": 0.2, "limits.least_slip_safety": 2.0}))
    assert differing_keys([run, other]) == [
        ("pulley[driven].inertia", ["0.1", "0.2"]),
        ("limits.least_slip_safety", ["by default", "2.0"]),
    ]
    assert differing_keys([run]) == []


def test_limits_stand_beside_their_numbers_though_others_are_not_judged(run: Run, tmp_path: Path) -> None:
    limits = {"largest_hub_load": 1e4, "least_cord_life": "100 h"}
    text = write_report(Run(run.dataset, run.drive.replace(limits=limits)), tmp_path / "a.html").read_text("utf-8")
    assert '<th scope="col">Limit</th>' in text
    assert "Least cord life: judged by beltdyn life" in text
    assert "gives no limits" not in text
    without = write_report(Run(run.dataset, run.drive.replace(limits={})), tmp_path / "b.html").read_text("utf-8")
    assert '<th scope="col">Limit</th>' not in without
    assert "gives no limits" in without
