"""The rooms raced in, and what is known of them."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import glb
from environment import HERE, REPOSITORY, WORK


@dataclass(frozen=True)
class Reference:
    """Values at the free points of a sensor, in malus' order, with their standard errors, by programs other than malus.

    `values` and `errors` are keyed by "s0", "s1", "ds0", as far as they are known.
    """

    points: np.ndarray
    normals: np.ndarray
    values: dict
    errors: dict


@dataclass(frozen=True)
class Room:
    name: str
    title: str
    scene: Path
    """malus' scene file."""
    sensor: str
    """The sensor of that file which is raced."""
    reference_file: Path
    overrides: tuple = ()
    share: float | None = None
    """The paper's a, in the paper's room."""
    radiance: Path | None = None
    substructuring: tuple = ()
    """Values of rtrace's -ds worth trying here; the last one is fine for all lamps."""
    mesh: Path | None = None

    def reference(self):
        if self.reference_file.suffix == ".csv":
            return _from_csv(self.reference_file)
        return _from_text(self.reference_file)

    def layout(self):
        """Points and normals of the sensor, where no reference tells them yet."""
        import malus

        return malus.layout(self)


def _from_csv(file):
    with open(file, newline="") as lines:
        rows = list(csv.DictReader(lines))

    def column(name):
        return np.array([float(row[name]) for row in rows])

    return Reference(
        points=np.column_stack([column(f"{axis}_m") for axis in "xyz"]),
        normals=np.column_stack([column(f"n{axis}") for axis in "xyz"]),
        values={name: column(name) for name in ("s0", "s1", "ds0")},
        errors={name: column(f"se_{name}") for name in ("s0", "s1", "ds0")},
    )


def _from_text(file):
    """Lines `x y z direct indirect total share`: total illuminance and its standard error as a share."""
    table = np.array([[float(word) for word in line.split()] for line in file.read_text().splitlines()])
    # Nine points lie inside furniture, where a leaked walk may have left a trace.
    table = table[table[:, 5] > 1.0]
    return Reference(
        points=table[:, :3],
        normals=np.tile([0.0, 0.0, 1.0], (len(table), 1)),
        values={"s0": table[:, 5]},
        errors={"s0": table[:, 5] * table[:, 6]},
    )


def _unit_room(share):
    return Room(
        name=f"unit-room-{share:g}",
        title=f"paper's room, a = {share:g}",
        scene=REPOSITORY / "scenes" / "unit-room.toml",
        sensor="floor",
        reference_file=HERE / "references" / f"unit-room-{share:g}.csv",
        overrides=(f"material.plaster.a={share:g}",),
        share=share,
        radiance=HERE / "rooms" / "unit-room.rad" if share == 0 else None,
        substructuring=(0.2, 0.01),
    )


UNIT_ROOMS = {share: _unit_room(share) for share in (0, 0.6, 1)}

REFERENCE_OFFICE = Room(
    name="reference-office",
    title="diffuse office, 264 points",
    scene=REPOSITORY / "tests" / "data" / "reference_office.toml",
    sensor="work plane",
    reference_file=REPOSITORY / "tests" / "data" / "office_ref.txt",
    radiance=HERE / "rooms" / "office.rad",
    substructuring=(0.2, 0.05),
)


def blender_office():
    """The office of scenes/, without the two of its sensors that are not raced."""
    original = REPOSITORY / "scenes" / "meshes" / "blender_office" / "office.glb"
    mesh = WORK / "office-work-plane.glb"
    WORK.mkdir(parents=True, exist_ok=True)
    glb.write_without(original, ("SENSOR_Eye", "SENSOR_Board"), mesh)
    return Room(
        name="blender-office",
        title="Blender office, 73 points",
        scene=REPOSITORY / "scenes" / "office.toml",
        sensor="SENSOR_Workplane",
        reference_file=HERE / "references" / "blender-office.csv",
        overrides=(f"mesh.0.file={mesh}",),
        mesh=mesh,
    )
