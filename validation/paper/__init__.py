"""Pages that compare results with what others published."""

from validation.paper.build import Outcome, build_paper

__all__ = ["Outcome", "build_paper"]
