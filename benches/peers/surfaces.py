"""Rooms as triangles with the values of their materials, for programs that know nothing of malus' scene files.

A surface is a dict of `vertices`, `faces` (front by winding) and `material` (rho, a, n, k, exitance, two_sided).
"""

import json
import math
import subprocess

import numpy as np

import environment
import glb

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
# Floor and four walls; the ceiling has a hole.
WALLS = [[0, 1, 3, 2], [0, 4, 5, 1], [1, 5, 7, 3], [3, 7, 6, 2], [2, 6, 4, 0]]
LAMP_SIDES = 128
LAMP_RADIUS = 0.05


def unit_room(share):
    """The paper's room at a = `share`. The lamp fills a hole in the ceiling: no two surfaces lie in one another."""
    plaster = _material(rho=0.5, a=share)
    lamp = _material(rho=0.0, a=0.0, exitance=1.0)
    walls = [triangle for wall in WALLS for triangle in (wall[:3], [wall[0], *wall[2:]])]
    rim = _rim()
    centre = len(rim)
    disc = [[centre, (side + 1) % centre, side] for side in range(centre)]
    return [
        {"vertices": CORNERS, "faces": walls, "material": plaster},
        {"vertices": np.vstack([rim, [0.5, 0.5, 1.0]]), "faces": disc, "material": lamp},
        _ceiling(rim, plaster),
    ]


def _rim():
    """A regular polygon of the disc's exact area, anticlockwise seen from above."""
    sector = 2 * math.pi / LAMP_SIDES
    radius = LAMP_RADIUS * math.sqrt(sector / math.sin(sector))
    angles = sector * np.arange(LAMP_SIDES)
    return np.column_stack(
        [0.5 + radius * np.cos(angles), 0.5 + radius * np.sin(angles), np.ones(LAMP_SIDES)]
    )


def _ceiling(rim, material):
    """A square with a hole: each corner looks at a quarter of the rim."""
    count = len(rim)
    corners = [[1, 1, 1], [0, 1, 1], [0, 0, 1], [1, 0, 1]]
    faces = []
    for corner in range(4):
        quarter = range(corner * count // 4, (corner + 1) * count // 4)
        faces += [[count + corner, side, (side + 1) % count] for side in quarter]
        end = ((corner + 1) * count // 4) % count
        faces.append([count + corner, end, count + (corner + 1) % 4])
    return {"vertices": np.vstack([rim, corners]), "faces": faces, "material": material}


def of_scene(room):
    """A room whose scene has one .glb file, as malus understands it: values from `malus check --json`, triangles from the file.

    Raises ValueError where the triangles or the area of a material are not those that malus counts.
    """
    command = [environment.MALUS, "check", "--json", room.scene]
    for override in room.overrides:
        command += ["--set", override]
    checked = subprocess.run(command, check=True, capture_output=True)
    report = json.loads(checked.stdout)
    triangles = glb.triangles(room.mesh)
    surfaces = []
    for material in report["materials"]:
        corners = triangles.pop((material["name"], material["object"]), None)
        if corners is None:
            corners = triangles.pop((material["name"], None))
        area = np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        ).sum() / 2
        if len(corners) != material["triangles"] or not math.isclose(area, material["area_m2"], rel_tol=1e-5):
            raise ValueError(
                f"{room.mesh}: {material['name']} has {len(corners)} triangles and {area} m², "
                f"malus counts {material['triangles']} and {material['area_m2']}"
            )
        surfaces.append(
            {
                "vertices": corners.reshape(-1, 3),
                "faces": np.arange(3 * len(corners)).reshape(-1, 3),
                "material": _material(**_values(material)),
            }
        )
    if triangles:
        raise ValueError(f"{room.mesh}: malus knows nothing of {sorted(map(str, triangles))}")
    return surfaces


def _values(material):
    given = {value["key"]: value["value"] for value in material["values"]}
    if given.get("kind", "mixture") != "mixture":
        raise ValueError(f"{material['name']} is a {given['kind']}, only mixtures are known here")
    values = {key: float(given[key]) for key in ("rho", "a", "n", "k", "exitance")}
    return values | {"two_sided": given["two_sided"] == "true"}


def _material(rho, a, n=1.5, k=0.0, exitance=0.0, two_sided=True):
    return {"rho": rho, "a": a, "n": n, "k": k, "exitance": exitance, "two_sided": two_sided}
