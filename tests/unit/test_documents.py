"""What the documents say of drive files is true."""

import ast
import re
import shlex
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

import key_tables
import mathml
import matplotlib.pyplot as plt
import pytest
import run_tasks
import tomli_w

from beltdyn.analyses import ANALYSES, EQUILIBRIUM, RUN
from beltdyn.cli import main
from beltdyn.designs.designs import free_numbers
from beltdyn.designs.residuals import read_measured
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.model import (
    Rating,
    Toothing,
    advise,
    dumps,
    install,
    load,
    loads,
)
from beltdyn.model.catalogue import Entry, read_catalogue
from beltdyn.model.parameter_study import CalibrationStudy, OptimizationStudy
from beltdyn.model.toml import example
from beltdyn.model.toothing import ToothRating
from beltdyn.parts.part import Part
from beltdyn.show.key_tables import AUTOMATIC, described, key_groups
from beltdyn.show.plot import FIGURES
from beltdyn.show.plot.figures import on_request
from beltdyn.transient.simulate import simulate

ROOT = Path(__file__).parents[2]
TUTORIAL = ROOT / "docs" / "tutorial.md"
MACHINES = ROOT / "docs" / "machines.md"
DRIVE_FILE = ROOT / "docs" / "drive_file.md"
CATALOGUE = ROOT / "docs" / "catalogue.md"
RESULTS = ROOT / "docs" / "results"


def pages(chapter: Path) -> list[Path]:
    """A page, and those below it where there are any."""
    return [chapter.with_suffix(".md"), *sorted(chapter.with_suffix("").glob("*.md"))]


def blocks(file: Path, language: str) -> list[str]:
    """Give the code blocks of a document that are in a language."""
    return re.findall(rf"```{language}\n(.*?)```", file.read_text(encoding="utf-8"), re.DOTALL)


@pytest.fixture
def new_drive() -> str:
    """The file that `beltdyn new` writes, cut short enough to be simulated in a test."""
    text = files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8")
    assert text.count("duration = 1.0") == text.count("# elements = 60") == 1
    return text.replace("duration = 1.0", "duration = 0.08").replace("# elements = 60", "elements = 20")


def test_the_readmes_drive_is_that_of_the_demo() -> None:
    (text,) = blocks(ROOT / "README.md", "toml")
    assert loads(text) == example("fan_direct_start")


@pytest.mark.parametrize("page", sorted((ROOT / "docs").rglob("*.md")), ids=lambda page: page.stem)
def test_tables_of_pages_are_current(page: Path, tables: dict[str, str]) -> None:
    """Otherwise `python docs/scripts/key_tables.py` writes them anew."""
    text = page.read_text(encoding="utf-8")
    assert key_tables.with_tables(text, tables) == text


def test_a_changed_table_is_noticed(tables: dict[str, str]) -> None:
    text = DRIVE_FILE.read_text(encoding="utf-8").replace("| `length` |", "| `lenght` |", 1)
    assert key_tables.with_tables(text, tables) != text


@pytest.fixture(scope="module")
def tables() -> dict[str, str]:
    current: dict[str, str] = key_tables.tables()
    return current


def test_descriptions_are_spelled_as_they_are_printed() -> None:
    text = described('the force, in N*s/m^2, under `length` or measuring_force, by "green"')
    assert key_tables.spelled(text) == 'the force, in N s/m², under `length` or `measuring_force`, by `"green"`'


def test_what_a_drive_chooses_is_in_the_tables() -> None:
    chosen = {f"{part.__name__.lower()}.{key}" for part, keys in AUTOMATIC.items() for key in keys}
    assert {choice.key for choice in example("alternator_drive").completed.choices} <= chosen


def test_every_table_of_keys_stands_on_a_page(tables: dict[str, str]) -> None:
    """But those of profiles and of kinds without a section, which have one together, and of groups without keys."""
    text = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").rglob("*.md"))
    shown = set(re.findall(r"^<!-- (keys[\w.]+) -->$", text, re.MULTILINE))
    apart = {f"keys.{family}.{kind}" for family in key_tables.FAMILIES for kind in key_tables.without_section(family)}
    empty = {f"keys.{name}" for name, group in key_groups().items() if not group.keys}
    assert shown == {
        name for name in tables if name.startswith("keys.") and not name.startswith("keys.profile.")
    } - apart - empty - {"keys.drive"}


@pytest.mark.parametrize("family", ["load", "hub", "tensioner"])
def test_every_kind_of_machine_has_a_section(family: str) -> None:
    text = MACHINES.read_text(encoding="utf-8")
    for name, group in key_groups().items():
        above, _, kind = name.partition(".")
        if above == family and kind != "shared" and group.keys and kind not in key_tables.without_section(family):
            section = text.split(f'\n### `kind = "{kind}"`\n')
            assert len(section) == 2, kind
            assert f"<!-- keys.{family}.{kind} -->" in section[1].split("\n#")[0]


@pytest.mark.parametrize("profile", PROFILES.values())
def test_every_key_of_a_profile_is_documented(profile: type[Part]) -> None:
    kind = profile.model_fields["kind"].default or "table"
    text = DRIVE_FILE.read_text(encoding="utf-8")
    rows = [row for row in text.splitlines() if row.startswith(f'| `{{ kind = "{kind}",')]
    assert rows
    assert all(f"{key} = " in rows[0] for key in profile.model_fields)


def test_the_catalogue_of_the_document_has_every_key(new_drive: str, tmp_path: Path) -> None:
    machine, own, catalogue, rating, curve, fatigue, teeth, rated_teeth = blocks(CATALOGUE, "toml")
    (entry,) = tomllib.loads(catalogue).values()
    others = [tomllib.loads(one)["my-belt"] for one in (rating, curve, fatigue, teeth, rated_teeth)]
    assert entry.keys() | {key for one in others for key in one} == Entry.model_fields.keys()
    assert others[0]["rating"].keys() == Rating.model_fields.keys()
    assert others[3]["toothing"].keys() == Toothing.model_fields.keys()
    assert others[4]["tooth_rating"].keys() == ToothRating.model_fields.keys()
    counts, of_teeth = rated_teeth.split("\n\n")
    without = "".join(line for line in catalogue.splitlines(keepends=True) if not line.startswith("lengths"))
    text = without + counts.partition("\n")[2] + "\n" + teeth + of_teeth
    (tmp_path / "rated.toml").write_text(text, encoding="utf-8")
    assert read_catalogue("rated.toml", tmp_path)["my-belt"].lengths == pytest.approx((0.8, 0.88, 0.96))
    (tmp_path / "toothed.toml").write_text(catalogue + teeth, encoding="utf-8")
    assert read_catalogue("toothed.toml", tmp_path)["my-belt"].toothing is not None
    without = "".join(line for line in catalogue.splitlines(keepends=True) if not line.startswith("axial_stiffness"))
    (tmp_path / "measured.toml").write_text(without + curve, encoding="utf-8")
    assert read_catalogue("measured.toml", tmp_path)["my-belt"].axial_stiffness == pytest.approx(1700.0)
    (tmp_path / "belts.toml").write_text(catalogue + rating + fatigue, encoding="utf-8")
    data = tomllib.loads(new_drive)
    for form in (*blocks(DRIVE_FILE, "toml")[:2], machine, own):
        belt = {
            key: value for key, value in tomllib.loads(form)["belt"].items() if key not in ("length", "nominal_length")
        }
        drive = loads(tomli_w.dumps(data | {"belt": belt | {"length": data["belt"]["length"]}}), base=tmp_path)
        assert loads(dumps(drive)) == drive


@pytest.mark.parametrize("example", blocks(MACHINES, "toml"))
def test_examples_of_machines_fit_the_new_drive(example: str, new_drive: str) -> None:
    """Their pulleys say only what differs; what a motor drives has no other torque."""
    data, changes = tomllib.loads(new_drive), tomllib.loads(example)
    given = {pulley["name"]: pulley for pulley in changes.get("pulley", [])}
    data["pulley"] = [pulley | given.get(pulley["name"], {}) for pulley in data["pulley"]]
    others = {key: value for key, value in changes.items() if key != "pulley"}
    drive = loads(tomli_w.dumps(data | {"tensioner": []} | others))
    assert drive != loads(new_drive)
    assert loads(dumps(drive)) == drive


@pytest.mark.parametrize(
    "document",
    [
        *(
            "README.md",
            "docs/fmu.md",
            "docs/index.md",
            "docs/machines.md",
            "docs/commands/designs.md",
        ),
        "docs/tutorial.md",
    ],
)
def test_python_blocks_run_one_after_another(
    document: str, new_drive: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("drive.toml").write_text(new_drive, encoding="utf-8")
    example = files("beltdyn.examples").joinpath("alternator_drive.toml")
    Path("alternator_drive.toml").write_text(example.read_text(encoding="utf-8"), encoding="utf-8")
    codes, names = blocks(ROOT / document, "python"), dict[str, Any]()
    assert codes
    plt.switch_backend("agg")
    try:
        for code in codes:
            exec(compile(code, document, "exec"), names)
    finally:
        plt.close("all")


@pytest.mark.slow
def test_the_tutorial_prints_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its blocks run with the drive of `beltdyn new` as it is; numbers are compared to 2 %."""
    monkeypatch.chdir(tmp_path)
    Path("drive.toml").write_text(files("beltdyn.cli").joinpath("new_drive.toml").read_text("utf-8"), encoding="utf-8")
    parts = re.split(r"```python\n(.*?)```", TUTORIAL.read_text(encoding="utf-8"), flags=re.DOTALL)
    names, told = dict[str, Any](), 0
    plt.switch_backend("agg")
    for code, text in zip(parts[1::2], parts[2::2], strict=True):
        exec(compile(code, "tutorial", "exec"), names)
        printed = capsys.readouterr().out
        for said in re.findall(r"It prints `(.*?)`", text):
            told += 1
            number = r"\d+(?:\.\d+)?"
            assert re.sub(number, "#", said) in re.sub(number, "#", printed)
            expected, found = ([float(one) for one in re.findall(number, words)] for words in (said, printed))
            assert found == pytest.approx(expected, rel=0.02)
    plt.close("all")
    assert told == 1


COSTLY_TASKS = {"accessory_drive", "belt", "design", "printer_axis", "python", "resonance", "slip", "squeal"}
"""Tasks that optimize, calibrate, simulate over time, and compute responses and squeal."""


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] if page.stem in COSTLY_TASKS else [])
        for page in run_tasks.pages()
        if "```python" in page.read_text(encoding="utf-8")
    ],
)
def test_tasks_print_what_they_say(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same words, and numbers to 2 % and a unit of the last digit."""
    monkeypatch.chdir(tmp_path)
    number = r"\d+(?:\.\d+)?"
    told = list(run_tasks.printed(page))
    assert told
    for said, found in told:
        assert re.sub(number, "#", said) == re.sub(number, "#", found)
        for one, other in zip(re.findall(number, said), re.findall(number, found), strict=True):
            digit = 10.0 ** -len(one.partition(".")[2])
            assert float(other) == pytest.approx(float(one), rel=0.02, abs=1.01 * digit)


@pytest.mark.parametrize("file", sorted((ROOT / "docs" / "tasks").glob("*.toml")), ids=lambda file: file.stem)
def test_drives_of_tasks_raise_no_doubts(file: Path) -> None:
    """And a page shows or links each."""
    drive = load(file)
    assert advise(drive, install(drive)) == []
    assert any(file.name in page.read_text(encoding="utf-8") for page in (ROOT / "docs").rglob("*.md"))


def test_each_task_is_reached_from_the_first_page_and_the_guide() -> None:
    for page in run_tasks.pages():
        for index in ("index.md", "guide.md"):
            assert f"(tasks/{page.name})" in (ROOT / "docs" / index).read_text(encoding="utf-8")


def test_formulas_of_all_pages_are_written_without_leftovers() -> None:
    """As MathML, in which no command of LaTeX and no separator of columns is left."""
    count = 0
    for page in (ROOT / "docs").rglob("*.md"):
        text = re.sub(r"```.*?```|`[^`]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
        text = re.sub(r"^ {4}.*$", "", text, flags=re.MULTILINE)
        for shown, inline in re.findall(r"\$\$(.*?)\$\$|\$([^$]+?)\$", text, flags=re.DOTALL):
            found = mathml.written(shown or inline, bool(shown))
            count += 1
            assert re.search(r"\\[a-zA-Z]|<mi>&</mi>", found) is None, (page.name, shown or inline)
    assert count > 700


def test_python_of_the_pages_on_results_runs(new_drive: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its drive has an alternator, and runs longer."""
    monkeypatch.chdir(tmp_path)
    simulate(loads(new_drive), "drive.nc")
    code = "\n".join(block for page in pages(RESULTS) for block in blocks(page, "python"))
    assert {"alternator", "start=0.9"} <= set(re.findall(r"alternator|start=0.9", code))
    exec(code.replace("alternator", "driven").replace("start=0.9", "start=0.05"), {})


@pytest.mark.parametrize(
    "document",
    [
        "README.md",
        pytest.param("docs/tutorial.md", marks=pytest.mark.slow),
        *(
            pytest.param(f"docs/examples/{file.name}", marks=pytest.mark.slow)
            for file in sorted((ROOT / "docs" / "examples").glob("*.md"))
        ),
    ],
)
def test_commands_run_one_after_another(document: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With short runs; a run-up has too few turns for its figures then, and nothing moves at their end, or yet.

    The optimization of an edited file is that of `test_tensioner_study.py`.
    """
    monkeypatch.chdir(tmp_path)
    text = (ROOT / document).read_text(encoding="utf-8")
    commands = [shlex.split(line, comments=True)[1:] for line in re.findall(r"^    (beltdyn .*)$", text, re.MULTILINE)]
    assert commands[0][0] == "new"
    for words in commands:
        if words[0] in ("sweep", "optimize") or any("-sweep" in word or "-optimize" in word for word in words):
            continue
        with pytest.raises(SystemExit) as ended:
            main([*words, "--at", "60"] if words[0] in ("steady-state", "operating-map", "traction") else words)
        assert ended.value.code == 0, words
        for file in tmp_path.glob("*.toml"):
            drive = file.read_text(encoding="utf-8")
            for key, value in ("duration", "0.01"), ("output_interval", "0.001"):
                drive = re.sub(f"^{key} = .*$", f"{key} = {value}", drive, flags=re.MULTILINE)
            file.write_text(drive, encoding="utf-8")
    plt.close("all")


def test_the_tutorials_pulleys_fit_the_new_drive(new_drive: str, tmp_path: Path) -> None:
    (table,) = blocks(TUTORIAL, "text")
    (tmp_path / "speed.csv").write_text(table, encoding="utf-8")
    changes = blocks(TUTORIAL, "toml")
    assert len(changes) == 2
    for change in changes:
        data = tomllib.loads(new_drive)
        (pulley,) = tomllib.loads(change)["pulley"]
        others = [other for other in data["pulley"] if other["name"] != pulley["name"]]
        assert len(others) == 1
        pulleys = sorted([pulley, *others], key=lambda item: str(item["name"]), reverse=True)
        changed = loads(tomli_w.dumps(data | {"pulley": pulleys}), base=tmp_path)
        assert changed != loads(new_drive)


def test_the_studies_of_the_task_fit_the_example(tmp_path: Path) -> None:
    """Numbers, requirements and the table of measurements are those of the alternator drive."""
    page = ROOT / "docs" / "tasks" / "design.md"
    example = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    optimisation, calibration = (tomllib.loads(block) for block in blocks(page, "toml"))
    drive, best, fitted = loads(example), OptimizationStudy(**optimisation), CalibrationStudy(**calibration)
    assert [one.start for one in free_numbers(drive, [*best.numbers, *fitted.numbers])] == [300.0, pytest.approx(12e4)]
    (table,) = (text for text in blocks(page, "text") if text.startswith("load, "))
    (tmp_path / fitted.measurements[0].table).write_text(table, encoding="utf-8")
    measured = read_measured(tmp_path / fitted.measurements[0].table, drive)
    assert list(measured.results) == list(measured.deviations) == ["pulley_slip[alternator]"]
    assert measured.rows == 3


def test_the_map_names_every_folder_and_files_that_exist() -> None:
    source, text = ROOT / "src" / "beltdyn", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    map_ = text[text.index("## The house") : text.index("## Habits")]
    folders = {path.parent.name for path in source.glob("*/__init__.py")}
    told = re.findall(r"^\|[^|]*\| ([^|]*) \|", map_, flags=re.MULTILINE)
    assert {name for cell in told for name in re.findall(r"`(\w+)`", cell)} - {"records", "quadrature"} == folders
    named = re.findall(r"`(\w+(?:/\w+)*\.py)`", map_)
    assert len(named) > 20
    assert [name for name in named if not (source / name).exists()] == []


def test_the_page_on_figures_names_every_one() -> None:
    """Those that are drawn where none is chosen, and those on request; and which show a drive at rest."""
    section = (RESULTS / "figures.md").read_text(encoding="utf-8")
    essential, others = section.split("Others are drawn")[:2]
    named = re.findall(r"`(\w+)`", essential + others)
    assert len(FIGURES.keys() & set(named)) > 30
    for name in FIGURES.keys() & set(named):
        assert name in (others if FIGURES[name].by_default is on_request else essential), name
    assert "<!-- kinds.figure -->" in (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")
    rest = re.search(r"A drive at rest has (.*?)\.", section, re.DOTALL)
    assert rest is not None
    of_rest = {name for name, figure in FIGURES.items() if EQUILIBRIUM in figure.of and RUN in figure.of}
    assert set(re.findall(r"`(\w+)`", rest.group(1))) == of_rest


def test_the_commands_page_names_analyses_that_there_are() -> None:
    """All are in the table of the reference, which is made from their list."""
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    assert len([one for one in ANALYSES.values() if f"| `beltdyn {one.command} FILE" in text]) > 12
    assert "<!-- kinds.analysis -->" in (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")


def test_files_named_by_the_page_on_theory_exist() -> None:
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[\]\(theory/.*$", text, flags=re.MULTILINE)
    named = [name for row in rows for name in re.findall(r"`([a-z_/]+(?:/|\.py))`", row)]
    assert len(rows) == 7
    assert [name for name in named if not (ROOT / "src" / "beltdyn" / name).exists()] == []


def test_tests_and_scripts_that_pages_name_exist() -> None:
    named = {
        name
        for page in (ROOT / "docs").rglob("*.md")
        for name in re.findall(
            r"\b(?:tests|benchmarks|docs|tools)/[\w/]+(?:\.py|(?=[ `\n]))", page.read_text(encoding="utf-8")
        )
    }
    assert len(named) > 50
    assert sorted(name for name in named if not (ROOT / name).exists()) == []


def literal(argument: ast.expr) -> str:
    """The words of a string in the source, with … where something is filled in."""
    parts = argument.values if isinstance(argument, ast.JoinedStr) else [argument]
    return "".join(str(part.value) if isinstance(part, ast.Constant) else "…" for part in parts)


def test_every_warning_stands_on_the_page() -> None:
    calls = (node for file in (ROOT / "src").rglob("*.py") for node in ast.walk(ast.parse(file.read_text("utf-8"))))
    faults = {
        literal(node.args[0])
        for node in calls
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Finding" and node.args
    } - {"…"}
    assert len(faults) > 40
    cells = re.findall(r"^\| (.*?) \|", (ROOT / "docs" / "warnings.md").read_text(encoding="utf-8"), re.MULTILINE)
    phrases = [one.strip() for cell in cells for one in re.split("[;…]", cell) if len(one.split()) > 1]
    assert [fault for fault in faults if not any(phrase in fault for phrase in phrases)] == []
    assert [phrase for phrase in phrases if not any(phrase in fault for fault in faults)] == []
