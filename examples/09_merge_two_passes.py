"""Two passes, one cloud
=====================

Lay a second pass on the first where they overlap; the log had it 4 mm and a third of a degree off.

The passes are made up here, and could be clouds of any program; of scans, give their folders, or
``murkscan merge dive1 dive2 --out hull``.
"""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from scipy.spatial.transform import Rotation

import murkscan as ms
from murkscan.survey.merge import merge_passes


def scan_hull(first_mm: float, seed: int) -> np.ndarray:
    """Give points of a bumpy hull, 0.4 m along x from `first_mm` on, with 0.2 mm of noise."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(first_mm, first_mm + 400, 2.5), np.arange(-120, 120, 2.5))
    z = 800 + x**2 / 6000 + y**2 / 900 + 12 * np.sin(x / 19) * np.cos(y / 17)
    return 1e-3 * np.stack([x, y, z + 0.2 * rng.standard_normal(x.shape)], axis=-1).reshape(-1, 3)


folder = Path(mkdtemp(prefix="murkscan-"))
true = scan_hull(150.0, seed=2)
turn = Rotation.from_euler("z", 0.3, degrees=True)
logged = turn.apply(true) + np.array([0.003, -0.002, 0.002])
for name, points in (("first", scan_hull(0.0, seed=1)), ("second", logged)):
    np.savetxt(folder / f"{name}.xyz", points, fmt="%.6f")  # bare places, in metres

result = merge_passes([folder / "first.xyz", folder / "second.xyz"], folder / "hull")
for one in result.passes:
    print(f"{one.path.rsplit('/')[-1]}: {one.words}")
merged = ms.Project(folder / "hull").load_cloud().points[-len(true) :]
print(f"before {1e3 * np.linalg.norm(logged - true, axis=1).mean():.2f} mm off,")
print(f"after {1e3 * np.linalg.norm(merged - true, axis=1).mean():.2f} mm")
