"""The script that measures the tables of the documentation again still measures each of them."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).parents[2] / "docs" / "scripts" / "measure.py"


def loaded() -> ModuleType:
    found = importlib.util.spec_from_file_location("measure", SCRIPT)
    assert found is not None
    assert found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.parametrize("name", loaded().MEASUREMENTS)
def test_a_table_is_measured(name: str) -> None:
    """With a heading, a line at least, and no cell that is not a number where others are."""
    heading, first, *more = [row for row in loaded().MEASUREMENTS[name]() if row]
    assert len(heading) == len(first)
    assert not any("nan" in cell.lower() for row in (first, *more) for cell in row)
