"""The wheel: for every system, or, with compiled kernels, for the system and the Python that compiled them."""

from pathlib import Path
from typing import Any
from zipfile import ZipFile

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class WheelHook(BuildHookInterface[Any]):
    """Chooses the tag of a wheel, and checks what is in it."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Tag a wheel that has compiled kernels; one that leads to the sources needs none."""
        if version != "editable" and Path(self.root, "src/beltdyn/kernel/shipped").is_dir():
            build_data["pure_python"] = False
            build_data["infer_tag"] = True

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Refuse a wheel without the package, or one for a system without its kernels."""
        if version == "editable":
            return
        with ZipFile(artifact_path) as wheel:
            names = wheel.namelist()
        lacks_kernels = build_data.get("infer_tag") and not any(name.endswith(".kernel") for name in names)
        if "beltdyn/__init__.py" not in names or lacks_kernels:
            Path(artifact_path).unlink()
            raise RuntimeError("The wheel lacks beltdyn or its compiled kernels. See its packages in pyproject.toml.")
