"""The state of an earlier run as initial state: its result file, and an instant."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Time


class EarlierRun(Part):
    """The state of an earlier run as initial state: positions and velocities of belt and bodies."""

    file: str = Field(description="the result file of the earlier run, relative to the folder of the drive file")
    time: Time | None = Field(
        None,
        ge=0,
        description="the instant of a field output of the earlier run, in s; by default the last one",
    )

    def __str__(self) -> str:
        return self.file if self.time is None else f"{self.file} at {self.time:g} s"

    @field_validator("file", mode="before")
    @classmethod
    def _starts_at_the_drive_file(cls, file: Any, info: ValidationInfo) -> Any:
        """The whole path, with which the drive means the same wherever its text goes."""
        if isinstance(file, Path):
            file = str(file)
        if not isinstance(file, str) or not file.strip() or "\0" in file:
            raise ValueError("must be the path of a result file, as text")
        base = (info.context or {}).get("base")
        return str((base or Path()).absolute() / file)


def _which(given: Any) -> str:
    """What is given, by the name of the part, or the type in JSON."""
    return EarlierRun.__name__ if isinstance(given, Mapping | EarlierRun) else "string"


Start = Annotated[
    Annotated[Literal["equilibrium", "laid", "steady"], Tag("string")] | Annotated[EarlierRun, Tag("EarlierRun")],
    Discriminator(_which),
]
"""The initial state of a run: a name, or an earlier run."""
