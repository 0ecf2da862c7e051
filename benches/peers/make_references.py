"""Makes the references of the races: `python make_references.py NAME…`, or all. Minutes to an hour of computing.

Where a = 1 in the paper's room the values are exact (images.py). For the others Mitsuba's path integrator is run long,
in batches whose spread gives the standard errors. malus only reads the office's materials and says where its points are.
"""

import csv
import math
import os
import sys

import numpy as np

import environment

BATCHES = 32
COLUMNS = ("x_m", "y_m", "z_m", "nx", "ny", "nz", "s0", "se_s0", "s1", "se_s1", "ds0", "se_ds0")
FLOOR = [(x / 10, 0.5, 0.0) for x in range(1, 10)]


def mirrored_room():
    import images

    half = np.array([images.floor_illuminance((x / 10, 0.5)) for x in range(1, 6)])
    s0, s1, scalar = np.vstack([half, half[3::-1]]).T
    # The lamp of the races is a polygon of 128 sides and of the disc's area.
    error = 3e-6 * s0
    return FLOOR, [s0, error, s1, error, s0 - scalar, error]


def glossy_room(walks=1 << 18):
    import surfaces

    room = {"points": FLOOR[:5], "normals": [UP] * 5, "surfaces": surfaces.unit_room(0.6)}
    batches = _batches(room, walks, image_stage())
    # Points that mirror each other have the same light.
    values = [np.concatenate([row, row[3::-1]]) for row in _summary(batches)]
    return FLOOR, values


def blender_office(walks=1 << 11):
    import rooms
    import surfaces
    from stage import Stage

    room = rooms.blender_office()
    points, normals = room.layout()
    exported = surfaces.of_scene(room)
    batches = _batches({"points": points, "normals": normals, "surfaces": exported}, walks, Stage)
    return points, _summary(batches)


UP = (0.0, 0.0, 1.0)
REFERENCES = {
    "unit-room-1": mirrored_room,
    "unit-room-0.6": glossy_room,
    "blender-office": blender_office,
}


def _batches(room, walks, stage):
    """S0, S1 and ds0 of every batch: (batch, quantity, point). The scalar run takes the same walks: ds0 is paired."""
    # Mirrors are drawn more often than they reflect: light by way of them is where the noise is.
    polarised, scalar = (stage(room, scalar=model, mirror_share=0.5) for model in (False, True))
    found = []
    for batch in range(BATCHES):
        (s0, s1), _ = polarised.irradiance(walks, 1000 + batch, sampler="multijitter")
        (unpolarised, _), seconds = scalar.irradiance(walks, 1000 + batch, sampler="multijitter")
        found.append((s0, s1, s0 - unpolarised))
        print(f"batch {batch + 1} of {BATCHES}: {seconds:.1f} s", file=sys.stderr, flush=True)
    return np.array(found)


def _summary(batches):
    means = batches.mean(axis=0)
    errors = batches.std(axis=0, ddof=1) / math.sqrt(len(batches))
    return [row for pair in zip(means, errors) for row in pair]


def image_stage():
    """A stage that aims half of its first rays at the lamp's images in the walls, which chance finds but rarely."""
    from stage import Stage
    from surfaces import LAMP_RADIUS

    images = [
        (i + 0.5, j + 0.5, 1.0 + 2 * m)
        for i in range(-2, 3)
        for j in range(-2, 3)
        for m in range(2)
        if 1 <= abs(i) + abs(j) + m <= 2
    ]

    class ImageStage(Stage):
        def _look(self, random, place, normal):
            mi, dr = self.mi, self.dr
            cosine, _ = super()._look(random, place, normal)
            choice, part = random.next_1d(), random.next_1d() * len(images)
            spot = mi.warp.square_to_uniform_disk_concentric(random.next_2d()) * LAMP_RADIUS
            centre = mi.Point3f(0.0)
            for index, image in enumerate(images):
                chosen = (part >= index) & (part < index + 1)
                centre = dr.select(chosen, mi.Point3f(*image), centre)
            target = centre + mi.Vector3f(spot.x, spot.y, 0.0)
            look = dr.select(choice < 0.5, dr.normalize(target - place), cosine)
            share = dr.maximum(1e-9, look.z) / dr.pi
            density = 0.5 * share
            for image in images:
                distance = (image[2] - place.z) / dr.maximum(1e-9, look.z)
                met = place + distance * look
                within = dr.square(met.x - image[0]) + dr.square(met.y - image[1]) < LAMP_RADIUS**2
                area = len(images) * math.pi * LAMP_RADIUS**2
                density += dr.select(within, 0.5 * dr.square(distance) / (area * look.z), 0.0)
            return look, share / density

    return ImageStage


def main(names):
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", environment.llvm())
    environment.build_malus()
    for name in names or REFERENCES:
        points, values = REFERENCES[name]()
        with open(environment.HERE / "references" / f"{name}.csv", "w", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(COLUMNS)
            for index, point in enumerate(points):
                row = [*point, *UP, *(column[index] for column in values)]
                table.writerow([f"{value:.9g}" for value in row])


if __name__ == "__main__":
    environment.enter()
    main(sys.argv[1:])
