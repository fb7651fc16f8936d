from typing import Callable, List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vector = Sequence[float]
"""x y z"""

__version__: str

class SetupError(Exception):
    """A refused set-up; the message has the hint at its end."""

    kind: str
    """For example "inverted_element": docs/errors.md."""
    ids: List[int]
    """The first 16 nodes or elements, as in the mesh as given."""
    count: int
    """Of all affected."""
    value: float
    threshold: float
    hint: str

def policies() -> List[str]:
    """Names of all compositions, "element/material/solver"."""

def status_names(status: int) -> List[str]:
    """Names of the flags of a status, for example ["Saturated", "Ramping"]."""

class Mesh:
    node_count: int
    def __init__(self, positions: ArrayLike, cells: ArrayLike, regions: Optional[ArrayLike] = None) -> None:
        """Arrays of shape (n, 3) [m] and (m, 4, 8, 10 or 20), and a region per cell; copied. TypeError for cells and
        regions that are no integers, SetupError for integers that 32 bits do not hold."""
    @staticmethod
    def read(path: str, scale: float = 1.0) -> Mesh:
        """A mesh file; `scale` is its unit in metres."""
    def add_group(self, name: str, nodes: ArrayLike) -> None:
        """Numbers of nodes. TypeError for a mask (use np.flatnonzero) or floats."""
    def add_group_in_box(self, name: str, low: Vector, high: Vector) -> None: ...

class Scene:
    """Supports, loads and touchable parts; every function returns the scene."""

    def __init__(self) -> None: ...
    def fix(self, group: str) -> Scene: ...
    def prescribe(self, group: str, displacement: Sequence[Optional[float]]) -> Scene: ...
    def traction(self, group: str, traction: Vector) -> Scene: ...
    def pressure(self, group: str, pressure: float) -> Scene: ...
    def point_load(self, group: str, force: Vector) -> Scene: ...
    def gravity(self, acceleration: Vector) -> Scene: ...
    def touch(self, group: str, radius: float = 0.0) -> Scene: ...
    def render(self, group: str) -> Scene: ...

class Material:
    def __init__(self, *, youngs_modulus: float, poisson_ratio: float, density: float = 0.0, region: str = "") -> None: ...

class Tissue:
    def __init__(
        self, mesh: Mesh, scene: Scene, policy: str, materials: Sequence[Material], *,
        progress: Optional[Callable[[str, float], Optional[bool]]] = None, threads: int = 0, repair: bool = False,
        force_error_places: int = 0, memory_limit: int = 0, quasi_static: bool = False, step: float = 0.0,
        mass_damping: float = 0.0, cache_file: Optional[str] = None) -> None:
        """Set-up. `progress(stage, fraction)` returns False to cancel; Ctrl-C cancels too. Other threads run."""
    def report_json(self) -> str: ...
    def displacement(self) -> NDArray[np.float64]:
        """Of every node of the mesh as given, shape (n, 3) [m]."""
    def set_pose(self, position: Vector, quaternion: Sequence[float]) -> None: ...
    def set_gravity(self, gravity: Vector) -> None: ...
    def reset(self) -> None: ...
    def cut(self, sheet: Sequence[Vector]) -> None: ...

class Tool: ...

def Sphere(radius: float = 4e-3) -> Tool: ...
def Capsule(radius: float, half_length: float, axis: Vector = (0.0, 0.0, 1.0)) -> Tool: ...
def Blade(edge: Vector, toughness: float = 100.0, cut_spacing: float = 1e-3) -> Tool: ...

class Session:
    vertices: NDArray[np.float32]
    """View, shape (points, 3) [m]; filled by read_surface."""
    normals: NDArray[np.float32]
    triangles: NDArray[np.int32]
    def __init__(
        self, tissue: Tissue, tools: Sequence[Tool], *, rate: float = 0.0, peak_force: float = 0.0,
        stiffness: float = 0.0, friction: float = 0.0, limit_energy: bool = False, manual_work: bool = False) -> None:
        """A value of 0 is the default."""
    def tick(self, x: float, y: float, z: float, time: float) -> int:
        """One tick of the only tool: returns the status; the views `force` have the results."""
    def tick_tools(self, positions: ArrayLike, time: float) -> List[int]:
        """One tick of all tools, positions of shape (tools, 3) [m]: returns the status of each."""
    def run(self, positions: ArrayLike, times: ArrayLike) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Ticks along a path: positions of shape (n, 3) with one tool, (n, tools, 3) with several [m]. Returns forces
        and contact forces of the same shape [N]. Other threads run."""
    def reset(self) -> None: ...
    def work(self) -> bool: ...
    def read_surface(self) -> None:
        """Fills `vertices` and `normals` with the surface after the newest tick."""
    def update_surface(self) -> bool:
        """For tissue that is cut: True when there are new arrays of vertices, normals and triangles."""
    def force(self, tool: int = 0) -> NDArray[np.float64]:
        """View of the force for the device after each tick [N]."""
    def contact_force(self, tool: int = 0) -> NDArray[np.float64]: ...
    def status(self, tool: int = 0) -> int: ...
    def error_bound(self, tool: int = 0) -> float: ...
