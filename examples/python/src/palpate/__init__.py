"""Finite elements for haptics: the force of soft tissue on a tool, every millisecond.

Units are SI. `help(palpate.Tissue)` and the type stubs (_palpate.pyi) list all arguments.
"""
from ._palpate import (
    Blade, Capsule, Material, Mesh, Scene, Session, SetupError, Sphere, Tissue, Tool, __version__, policies,
    status_names)

__all__ = ["Blade", "Capsule", "Material", "Mesh", "Scene", "Session", "SetupError", "Sphere", "Tissue", "Tool",
           "policies", "status_names"]
