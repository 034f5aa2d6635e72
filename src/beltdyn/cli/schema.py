"""`beltdyn schema`."""

import json

from beltdyn.cli.console import show


def schema() -> None:
    """Print the JSON schema of drive files, for checks and completion in editors."""
    from beltdyn.model import json_schema

    show(json.dumps(json_schema(), indent=2, ensure_ascii=False))
