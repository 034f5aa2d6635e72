"""What the documents say of drive files is true."""

import re
from pathlib import Path

import pytest

from beltdyn.model import Belt, Contact, Drive, Pulley, Simulation, loads

ROOT = Path(__file__).parents[2]


def test_the_readmes_drive_is_the_papers(drive: Drive) -> None:
    (example,) = re.findall(r"```toml\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    mine = loads(example)
    without_load = drive.pulleys[1].replace(torque=None)
    assert mine == drive.replace(pulley=[drive.pulleys[0], without_load])


@pytest.mark.parametrize("part", [Belt, Pulley, Contact, Simulation])
def test_every_key_is_documented(part: type[Belt | Pulley | Contact | Simulation]) -> None:
    text = (ROOT / "docs" / "drive_file.md").read_text(encoding="utf-8")
    for key, field in part.model_fields.items():
        description = re.escape(str(field.description)[1:])
        assert re.search(rf"\| `{key}` \| .{description} \|", text)
