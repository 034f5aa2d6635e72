"""A study: files that grow as points finish, and go on where they were."""

import csv
import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from beltdyn.designs import point_work, study_table
from beltdyn.designs.point_work import Outcome
from beltdyn.designs.processes import ThisProcess
from beltdyn.designs.study import study
from beltdyn.designs.study_plan import plan_of
from beltdyn.designs.study_table import StudyTable
from beltdyn.errors import ModelError
from beltdyn.model import Drive, ParameterStudy, dumps
from beltdyn.results import Result, open_result
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.equilibrium import equilibrium

STUDY = """
drive = "drive.toml"
analysis = "equilibrium"
results = ["hub_load", "tension"]

[[number]]
path = "belt.width"
values = "10, 12, 14 mm"

[[number]]
path = "pulley[driver].radius"
values = [0.081, 0.0815, -1.0]
"""


@pytest.fixture
def study_file(tmp_path: Path, drive_file: Path) -> Path:
    """Of nine points of which three fail."""
    file = tmp_path / "study.toml"
    text = STUDY.replace("-1.0", "0.08")  # the belt would hang slack
    file.write_text(text, encoding="utf-8")
    return file


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def counted(monkeypatch: pytest.MonkeyPatch) -> list[Mapping[str, object]]:
    """Notes the points that are computed from now on."""
    computed: list[Mapping[str, object]] = []
    inner = point_work._analysed

    def analysed(work: point_work.PointWork, point: int, changes: Mapping[str, object]) -> Result:
        computed.append(changes)
        return inner(work, point, changes)

    monkeypatch.setattr(point_work, "_analysed", analysed)
    return computed


def test_points_are_those_of_single_analyses(study_file: Path, drive: Drive) -> None:
    found = study(study_file, jobs=1).dataset
    assert found.sizes["point"] == 9
    one = equilibrium(drive.with_({"belt.width": 0.012, "pulley[driver].radius": 0.0815}))
    place = int(np.flatnonzero((found["belt.width"] == 0.012) & (found["pulley[driver].radius"] == 0.0815))[0])
    assert float(found["hub_load[driven]"][place]) == float(one.dataset["hub_load"][1])
    assert found["hub_load[driven]"].attrs["units"] == "N"
    assert found["belt.width"].attrs["units"] == "m"
    failed = found["failure"].values != ""
    assert failed.sum() == 3
    assert np.isnan(found["tension"].values[failed]).all()
    assert np.isfinite(found["tension"].values[~failed]).all()
    assert np.unique(found["pulley[driver].radius"].values[failed]).tolist() == [0.08]


def test_files_hold_all_points_and_are_read_again(study_file: Path, tmp_path: Path) -> None:
    result = study(study_file, output=tmp_path / "s.nc", jobs=1)
    rows = rows_of(tmp_path / "s.csv")
    assert [row["point"] for row in rows] == [str(number) for number in range(1, 10)]
    assert [row["tension [N]"] for row in rows][:2] == [repr(float(one)) for one in result.dataset["tension"][:2]]
    assert rows[2]["tension [N]"] == ""
    assert rows[2]["failure"]
    opened = open_result(tmp_path / "s.nc")
    assert opened.kind == "study"
    assert opened.status == "completed"
    assert opened.dataset["tension"].equals(result.dataset["tension"])
    assert opened.warnings[0] == "3 of 9 points failed."


def test_nothing_is_computed_twice(study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = study(study_file, output=tmp_path / "s.nc", jobs=1)
    computed = counted(monkeypatch)
    again = study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert computed == []
    assert again.dataset["tension"].equals(first.dataset["tension"])
    study_file.write_text(study_file.read_text(encoding="utf-8").replace("14 mm", "14, 16 mm"), encoding="utf-8")
    more = study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert [one["belt.width"] for one in computed] == [0.016] * 3
    assert int(more.dataset.attrs["done"]) == 12
    study(study_file, output=tmp_path / "s.nc", jobs=1, retry=True)
    assert len(computed) == 3 + 4


@pytest.mark.parametrize("row", [4, *(pytest.param(one, marks=pytest.mark.slow) for one in (1, 9))])
def test_a_damaged_row_is_computed_again(
    row: int, study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A digit that has changed on the disk never becomes a result."""
    first = study(study_file, output=tmp_path / "s.nc", jobs=1)
    lines = (tmp_path / "s.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    place = lines[row].rindex("0.")
    lines[row] = lines[row][: place + 2] + chr(ord(lines[row][place + 2]) ^ 1) + lines[row][place + 3 :]
    (tmp_path / "s.csv").write_text("".join(lines), encoding="utf-8")
    computed = counted(monkeypatch)
    again = study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert len(computed) == 1
    assert again.dataset["tension"].equals(first.dataset["tension"])


def test_rows_under_a_damaged_head_are_refused(study_file: Path, tmp_path: Path) -> None:
    study(study_file, output=tmp_path / "s.nc", jobs=1)
    text = (tmp_path / "s.csv").read_text(encoding="utf-8")
    (tmp_path / "s.csv").write_text(text.replace("tension [N]", "tensiom [N]", 1), encoding="utf-8")
    with pytest.raises(ModelError, match="is damaged: no row has its checksum"):
        study(study_file, output=tmp_path / "s.nc", jobs=1)


def test_a_row_that_was_cut_off_is_computed_again(
    study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = study(study_file, output=tmp_path / "s.nc", jobs=1)
    text = (tmp_path / "s.csv").read_text(encoding="utf-8")
    (tmp_path / "s.csv").write_text(text[: text.rindex("\n", 0, -1) - 30], encoding="utf-8")
    computed = counted(monkeypatch)
    again = study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert len(computed) == 2
    assert again.dataset["tension"].equals(first.dataset["tension"])
    assert len(rows_of(tmp_path / "s.csv")) == 9


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ('["hub_load", "tension"]', '["tension"]', "9 points of a study with another list of results"),
        ("10, 12, 14 mm", "10, 12 mm", "no longer in the study"),
        ('path = "belt.width"', 'path = "belt.thickness"', "holds no points of this study"),
    ],
)
def test_points_of_another_study_are_not_lost(
    study_file: Path, tmp_path: Path, before: str, after: str, said: str
) -> None:
    study(study_file, output=tmp_path / "s.nc", jobs=1)
    kept = (tmp_path / "s.csv").read_bytes()
    study_file.write_text(study_file.read_text(encoding="utf-8").replace(before, after), encoding="utf-8")
    with pytest.raises(ModelError, match=said):
        study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert (tmp_path / "s.csv").read_bytes() == kept
    assert study(study_file, output=tmp_path / "s.nc", jobs=1, overwrite=True).status == "completed"


@pytest.mark.parametrize(
    ("analysis", "options"),
    [("operating_map", {"speed": "10..20 rad/s"}), ("sweep", {"pulley": "driver", "from_": "60 rpm", "to": "90 rpm"})],
)
def test_a_speed_that_the_options_run_through_does_not_vary_besides(
    analysis: str, options: dict[str, str], drive: Drive
) -> None:
    number = {"path": "pulley[1].speed.value", "values": [10.0, 12.0]}
    with pytest.raises(ModelError, match=r'the column ".*speed" gives the number "pulley\[1\].speed.value"'):
        study(ParameterStudy(analysis=analysis, options=options, number=[number]), drive, jobs=1)


@pytest.mark.parametrize("changed", ["duty.csv", "optimize.toml", "option"])
def test_points_computed_with_other_options_are_not_taken(changed: str, drive: Drive, tmp_path: Path) -> None:
    """A file that an option names has changed, or one that such a file names, or an option itself."""
    (tmp_path / "duty.csv").write_text("share [%], load\n100, 1\n", encoding="utf-8")
    (tmp_path / "optimize.toml").write_text(
        '[[number]]\npath = "belt.width"\nleast = "9 mm"\nlargest = "16 mm"\n[goal]\nresult = "hub_load"\n'
        '[points]\ntable = "duty.csv"\n',
        encoding="utf-8",
    )
    (tmp_path / "drive.toml").write_text(dumps(drive), encoding="utf-8")
    file, text = (
        tmp_path / "s.toml",
        (
            'drive = "drive.toml"\nanalysis = "optimize"\n[options]\nstudy = "optimize.toml"\nmost = 2\n'
            '[[number]]\npath = "belt.thickness"\nvalues = "4, 4.1 mm"\n'
        ),
    )
    file.write_text(text, encoding="utf-8")
    study(file, output=tmp_path / "s.nc", jobs=1)
    study(file, output=tmp_path / "s.nc", jobs=1)
    kept = (tmp_path / "s.csv").read_bytes()
    if changed == "option":
        file.write_text(text.replace("most = 2", "most = 3"), encoding="utf-8")
    else:
        (tmp_path / changed).write_text(
            (tmp_path / changed).read_text(encoding="utf-8") + "# other\n", encoding="utf-8"
        )
    told = "option most" if changed == "option" else rf"content of {changed} \(option study\)"
    with pytest.raises(ModelError, match=rf"2 points of a study with another {told}\. Choose another --output"):
        study(file, output=tmp_path / "s.nc", jobs=1)
    assert (tmp_path / "s.csv").read_bytes() == kept


def test_an_interruption_keeps_points_and_goes_on(study_file: Path, tmp_path: Path) -> None:
    def stop(progress: Progress) -> None:
        if progress.phase == "points" and progress.time >= 4.0:
            raise KeyboardInterrupt

    stopped = study(study_file, output=tmp_path / "s.nc", jobs=1, progress=stop)
    assert stopped.status == "interrupted"
    done = len(rows_of(tmp_path / "s.csv"))
    assert 4 <= done < 9
    assert open_result(tmp_path / "s.nc").status == "interrupted"
    told: list[Progress] = []
    assert study(study_file, output=tmp_path / "s.nc", jobs=1, progress=told.append).status == "completed"
    assert next(one.time for one in told if one.phase == "points") > done
    assert told[-1].time == told[-1].duration == 9.0


def test_a_study_waits_for_workers_and_says_so(study_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Late(ThisProcess):
        asked = 0

        @property
        def slots(self) -> int:  # type: ignore[override]
            self.asked += 1
            return int(self.asked > 6)

    monkeypatch.setitem(study.__globals__, "workers_of", lambda jobs, scheduler: Late())
    told: list[Progress] = []
    found = study(study_file, progress=told.append).dataset
    phases = [one.phase for one in told]
    assert phases[1] == "no workers"
    assert phases[-1] == "points"
    assert phases == sorted(phases, key=("compiling", "no workers", "points").index)
    assert np.isfinite(found["tension"]).sum() == 6


@pytest.mark.slow
@pytest.mark.parametrize("rows_before", [1, 9])
def test_a_study_that_is_killed_goes_on(rows_before: int, study_file: Path, tmp_path: Path) -> None:
    """With processes of its own, which end with it, as soon as there is a row, and later."""
    text = study_file.read_text(encoding="utf-8").replace("10, 12, 14 mm", "10..14 mm")
    study_file.write_text(text.replace('values = "10..14 mm"', 'values = "10..14 mm"\nsteps = 60'), encoding="utf-8")
    program = f"import beltdyn as bd; bd.study({str(study_file)!r}, output={str(tmp_path / 's.nc')!r}, jobs=2)"
    process = subprocess.Popen([sys.executable, "-c", program])
    rows = tmp_path / "s.csv"
    while process.poll() is None and (not rows.exists() or rows.read_text(encoding="utf-8").count("\n") <= rows_before):
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    before = rows.read_text(encoding="utf-8").count("\n") - 1
    assert rows_before <= before < 180
    result = study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert result.status == "completed"
    points = [row["point"] for row in rows_of(rows)]
    assert sorted(points, key=int) == [str(number) for number in range(1, 181)]


def test_the_first_row_has_its_head(study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A study that is killed right behind its first row goes on there."""

    class Killed(BaseException):
        pass

    def append(self: StudyTable, outcomes: list[Outcome]) -> None:
        written(self, outcomes)
        raise Killed

    written = StudyTable._append
    with monkeypatch.context() as patch:
        patch.setattr(StudyTable, "_append", append)
        patch.setattr(StudyTable, "__exit__", lambda self, *_: self._lock.release())
        with pytest.raises(Killed):
            study(study_file, output=tmp_path / "s.nc", jobs=1)
    assert len(rows_of(tmp_path / "s.csv")) == 1
    computed = counted(monkeypatch)
    assert study(study_file, output=tmp_path / "s.nc", jobs=1).status == "completed"
    assert len(computed) == 8


def test_rows_without_their_head_are_not_taken(study_file: Path, tmp_path: Path) -> None:
    study(study_file, output=tmp_path / "s.nc", jobs=1)
    (tmp_path / "s.nc").unlink()
    with pytest.raises(ModelError, match=r"a study whose head .*s.nc is missing or damaged"):
        study(study_file, output=tmp_path / "s.nc", jobs=1)


def test_rows_that_failed_by_internal_errors_are_computed_again(
    study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are no results of the drive."""
    with monkeypatch.context() as patch:
        patch.setattr(point_work, "cause_of", lambda *_: "internal error in somewhere.py:1 (KeyError: 'x')")
        study(study_file, output=tmp_path / "s.nc", jobs=1)
    computed = counted(monkeypatch)
    found = study(study_file, output=tmp_path / "s.nc", jobs=1).dataset
    assert len(computed) == 3
    assert not [text for text in found["failure"].values if "internal" in text]


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("name", ["table", "drive"])
def test_no_input_is_overwritten(overwrite: bool, name: str, study_file: Path, tmp_path: Path) -> None:
    """The table of points has the name that rows of the study would have."""
    output = tmp_path / "points.nc" if name == "table" else tmp_path / "drive.toml"
    (tmp_path / "points.csv").write_text("belt.width [mm]\n10\n12\n", encoding="utf-8")
    head = study_file.read_text(encoding="utf-8").partition("[[number]]")[0]
    study_file.write_text(head + 'table = "points.csv"\n', encoding="utf-8")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(ModelError, match="is an input of the study; the results would overwrite it"):
        study(study_file, output=output, jobs=1, overwrite=overwrite)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize("saving", [1, 2])
def test_an_interruption_while_a_file_is_saved_waits(
    saving: int, study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the first saving, which is the head, and when all is done; twice, as impatient people do."""
    inner, count = Result.save, iter(range(1, 100))

    def save(self: Result, path: Path, overwrite: bool = False) -> Path:
        saved = inner(self, path, overwrite)
        if next(count) == saving:
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGINT)
            assert open_result(saved).kind == "study"
        return saved

    monkeypatch.setattr(Result, "save", save)
    monkeypatch.setattr(study_table, "_OFTEN", 1e9)
    text = study_file.read_text(encoding="utf-8")
    study_file.write_text(text.replace("[0.081, 0.0815, 0.08]", "[0.081]"), encoding="utf-8")
    found = study(study_file, output=tmp_path / "s.nc", jobs=1)
    done = len(rows_of(tmp_path / "s.csv"))
    assert open_result(tmp_path / "s.nc").status == found.status == ("interrupted" if saving == 1 else "completed")
    assert done == (1 if saving == 1 else 3)


def test_files_of_points_are_kept_where_asked_for(study_file: Path, tmp_path: Path) -> None:
    study_file.write_text("keep_files = true\n" + study_file.read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(ModelError, match="needs a result file"):
        study(study_file, jobs=1)
    study(study_file, output=tmp_path / "s.nc", jobs=1)
    kept = sorted((tmp_path / "s-points").glob("*.nc"))
    assert [one.name for one in kept] == [f"{number:06d}.nc" for number in (1, 2, 4, 5, 7, 8)]
    assert open_result(kept[3]).drive.belt.width == 0.012


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"results": ["hub_laod"]}, 'Did you mean "hub_load"'),
        ({"options": {"att": 1.0}}, "att is not an option"),
        ({"analysis": "traction", "options": {"slop": "1 %"}}, "slop is not an option"),
        ({"analysis": "sweep"}, '"sweep" needs pulley'),
    ],
)
def test_what_does_not_fit_is_told(drive: Drive, changes: dict[str, object], said: str) -> None:
    given = {"analysis": "equilibrium", "number": [{"path": "belt.width", "values": [0.01]}]} | changes
    with pytest.raises(ModelError, match=said):
        study(ParameterStudy(**given), drive, jobs=1)


def test_a_study_needs_a_drive(drive: Drive) -> None:
    given = ParameterStudy(number=[{"path": "belt.width", "values": [0.01]}])
    with pytest.raises(ModelError, match="names no drive"):
        study(given)


def test_modes_and_steady_running_are_studied_alike(drive: Drive) -> None:
    numbers = [{"path": "belt.width", "values": [0.01, 0.02]}]
    found = study(
        ParameterStudy(number=numbers, analysis="modes", results=["frequency"], options={"count": 3}), drive, jobs=1
    )
    assert [name for name in found.dataset.data_vars if str(name).startswith("frequency[")] == [
        "frequency[1]",
        "frequency[2]",
        "frequency[3]",
    ]
    steady = study(ParameterStudy(number=numbers, analysis="steady_state", results=["hub_load[driven]"]), drive, jobs=1)
    assert steady.dataset["hub_load[driven]"].values[1] == pytest.approx(
        2.0 * steady.dataset["hub_load[driven]"].values[0],
        rel=0.1,  # but for the centrifugal tension
    )


def test_a_duty_table_gives_no_number_that_varies(drive: Drive, tmp_path: Path) -> None:
    """Before anything is computed."""
    table, varied = tmp_path / "duty.csv", {"path": "pulley[1].speed.value", "values": [10.0, 20.0]}
    table.write_text("share [%], speed [rpm]\n50, 100\n50, 200\n", encoding="utf-8")
    wanted = ParameterStudy(analysis="duty", options={"table": str(table)}, number=[varied])
    with pytest.raises(ModelError, match=r'the column "speed" gives the number "pulley\[1\]\.speed\.value"'):
        study(wanted, drive, jobs=1)


def test_progress_tells_how_long_a_study_has_taken(study_file: Path) -> None:
    """From its begin, in order; no longer than since then."""
    text = study_file.read_text(encoding="utf-8")
    study_file.write_text(text.replace("[0.081, 0.0815, 0.08]", "[0.081]"), encoding="utf-8")
    progress, begun = list[tuple[Progress, float]](), time.perf_counter()
    study(study_file, jobs=1, progress=lambda told: progress.append((told, time.perf_counter() - begun)))
    points = [(told, since) for told, since in progress if told.phase == "points"]
    done = [told.time for told, _ in points]
    assert done == sorted(done)
    assert (done[-1], points[-1][0].duration) == (3.0, 3.0)
    assert all(0.0 <= told.elapsed <= since for told, since in points)
    assert all(earlier[0].elapsed <= later[0].elapsed for earlier, later in pairwise(points))


def test_rows_are_added_and_begin_anew_with_columns_that_come_later(
    drive: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the last writing was long ago, the result file knows of all of them at once; its lock goes at the end."""
    given = ParameterStudy(analysis="equilibrium", number=[{"path": "belt.width", "values": "10, 12, 14, 16 mm"}])
    output, table = tmp_path / "s.nc", tmp_path / "s.csv"

    def outcome(point: int, **values: float) -> Outcome:
        return Outcome(point, values, "", "", 0.1)

    with StudyTable(given, drive, plan_of(given, drive, tmp_path), output) as rows:
        rows.take([outcome(0, tension=1.0)], {"tension": "N"})
        first = table.stat().st_ino
        rows.take([outcome(1, tension=2.0)], {"tension": "N"})
        assert table.stat().st_ino == first
        assert open_result(output).dataset.attrs["done"] == 1
        monkeypatch.setattr(study_table, "_OFTEN", 0.0)
        rows.take([outcome(2, tension=3.0, belt_length=1.2)], {"tension": "N", "belt_length": "m"})
        rows._pause = 0.0
        rows.take([outcome(3, tension=4.0, belt_length=1.3)], {"tension": "N", "belt_length": "m"})
        assert open_result(output).dataset.attrs["done"] == 4
        assert list(tmp_path.glob(".*lock"))
    assert not list(tmp_path.glob(".*lock"))
    found = rows_of(table)
    assert [row["tension [N]"] for row in found] == ["1.0", "2.0", "3.0", "4.0"]
    assert [row["belt_length [m]"] for row in found] == ["", "", "1.2", "1.3"]


def test_any_file_is_overwritten_where_that_is_wished(drive: Drive, tmp_path: Path) -> None:
    given = ParameterStudy(analysis="equilibrium", number=[{"path": "belt.width", "values": "10, 12 mm"}])
    plan, output = plan_of(given, drive, tmp_path), tmp_path / "s.nc"
    output.write_text("of others", encoding="utf-8")
    with pytest.raises(ModelError, match="overwrite"):
        StudyTable(given, drive, plan, output)
    assert output.read_text(encoding="utf-8") == "of others"
    with StudyTable(given, drive, plan, output, overwrite=True) as rows:
        rows.take([Outcome(0, {"tension": 1.0}, "", "", 0.1)], {"tension": "N"})
    assert open_result(output).kind == "study"


@pytest.mark.parametrize(("seconds", "pause"), [(0.01, 2.0), (0.5, 10.0), (3.0, 60.0)])
def test_writing_the_result_file_takes_a_twentieth_of_the_time(
    drive: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seconds: float, pause: float
) -> None:
    """And happens every two seconds at most."""
    clock = iter(np.arange(0.0, 1000.0, seconds))
    monkeypatch.setattr(study_table, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    given = ParameterStudy(analysis="equilibrium", number=[{"path": "belt.width", "values": "10, 12 mm"}])
    with StudyTable(given, drive, plan_of(given, drive, tmp_path), tmp_path / "s.nc") as rows:
        rows.take([Outcome(0, {"tension": 1.0}, "", "", 0.1)], {"tension": "N"})
        assert rows._pause == pytest.approx(pause)


@pytest.mark.parametrize("failing", [0, 1, 2])
def test_results_without_a_value_at_any_point_are_named(drive: Drive, tmp_path: Path, failing: int) -> None:
    """Six of them, and how many more; none where all points failed."""
    given = ParameterStudy(analysis="equilibrium", number=[{"path": "belt.width", "values": "10, 12 mm"}])
    names = [f"result_{number}" for number in range(9)]
    with StudyTable(given, drive, plan_of(given, drive, tmp_path), None) as rows:
        for point in range(2):
            values = dict.fromkeys(names, np.nan) | {"result_8": 1.0}
            failed = point < failing
            rows.take([Outcome(point, {} if failed else values, "slack" if failed else "", "", 0.1)],
                      dict.fromkeys(names, "N"))  # fmt: skip
    told = [text for text in rows.result().warnings if text.startswith("no value at any point: ")]
    named = f"{', '.join(names[:6])} and 2 more."
    assert told == ([] if failing == 2 else [f"no value at any point: {named}"])
    assert (f"{failing} of 2 points failed." in rows.result().warnings) is (failing > 0)
    where = ["", "point 1", "point 1 and 1 more"][failing]
    assert (f"failed at {where}: slack" in rows.result().warnings) is (failing > 0)
