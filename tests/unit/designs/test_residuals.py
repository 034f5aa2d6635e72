"""Tables of measured results: what their headings mean."""

from pathlib import Path

import numpy as np
import pytest

from beltdyn.designs.residuals import read_measured
from beltdyn.errors import ModelError
from beltdyn.model import Drive


def measured(folder: Path, drive: Drive, *lines: str) -> Path:
    file = folder / "measured.csv"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def test_brackets_are_parts_of_paths_and_names_or_units(drive: Drive, tmp_path: Path) -> None:
    file = measured(
        tmp_path,
        drive,
        "belt.length [mm], pulley[driven].center[1], driven torque [N m], load, hub_load[driven], efficiency [%], "
        "± efficiency [%], ± hub_load[driven]",
        "1270, 0.4, -3, 1, 500, 98, 1, 5",
        "1272, 0.41, -4, 0.5, , 97, 2, 6",
    )
    table = read_measured(file, drive)
    assert table.rows == 2
    assert table.changes(1) == pytest.approx({"belt.length": 1.272, "pulley[driven].center[1]": 0.41})
    assert [(one.what, one.pulley, one.values) for one in table.points] == [
        ("torque", "driven", [-3.0, -4.0]),
        ("load", "", [1.0, 0.5]),
    ]
    assert list(table.results) == ["hub_load[driven]", "efficiency"]
    np.testing.assert_array_equal(table.results["hub_load[driven]"], [500.0, np.nan])
    np.testing.assert_allclose(table.results["efficiency"], [0.98, 0.97])
    np.testing.assert_allclose(table.deviations["efficiency"], [0.01, 0.02])
    np.testing.assert_allclose(table.deviations["hub_load[driven]"], [5.0, 6.0])


@pytest.mark.parametrize(
    ("heading", "said"),
    [
        ("speed [rpm]", 'the heading "speed" is not a result'),
        ("idler torque [N m]", "pulley = 'idler' is not in this drive"),
        ("hub_laod[driven]", 'Did you mean "hub_load'),
        ("± efficiency", 'needs a column "efficiency" beside it'),
    ],
)
def test_what_no_heading_may_say(drive: Drive, tmp_path: Path, heading: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        read_measured(measured(tmp_path, drive, f"{heading}, hub_load[driven]", "1, 2"), drive)
