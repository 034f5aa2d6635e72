"""The wheel: for every system, or, with compiled kernels, for the system and the Python that compiled them."""

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class WheelHook(BuildHookInterface[Any]):
    """Chooses the tag of a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Tag a wheel that has compiled kernels; one that leads to the sources needs none."""
        if version != "editable" and Path(self.root, "src/beltdyn/kernel/shipped").is_dir():
            build_data["pure_python"] = False
            build_data["infer_tag"] = True
