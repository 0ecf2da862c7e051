"""A room as Mitsuba sees it, and the light that its `path` integrator brings to points in it."""

import time

import numpy as np

import mixture

VARIANT = "llvm_ad_mono_polarized"
# Sensors lie on surfaces: rays leave by this much of the room's size, which single precision still resolves.
OFFSET = 1e-5
# Sums within a block stay in single precision, sums of blocks are made in double.
BLOCK = 64
# Walks in one kernel launch.
LAUNCH = 1 << 22


class Stage:
    """The scene of a room (see rooms.py) with its points of measurement."""

    def __init__(self, room, scalar=False, mirror_share=0.0):
        import drjit as dr
        import mitsuba as mi

        mi.set_variant(VARIANT)
        mixture.register(mi, dr)
        self.mi, self.dr = mi, dr
        self.points = np.asarray(room["points"], float)
        self.normals = np.asarray(room["normals"], float)
        contents = {"type": "scene"}
        for index, surface in enumerate(room["surfaces"]):
            contents[f"surface{index}"] = self._mesh(index, surface, scalar, mirror_share)
        self.scene = mi.load_dict(contents)
        box = self.scene.bbox()
        self.offset = OFFSET * float(dr.norm(box.max - box.min))

    def _mesh(self, index, surface, scalar, mirror_share):
        mi = self.mi
        vertices = np.asarray(surface["vertices"], np.float32)
        faces = np.asarray(surface["faces"], np.uint32)
        values = surface["material"]
        properties = mi.Properties()
        properties["bsdf"] = mi.load_dict(
            {
                "type": "mixture",
                "rho": values["rho"],
                "a": values["a"],
                "n": values["n"],
                "k": values["k"],
                "two_sided": values["two_sided"],
                "scalar": scalar,
                "mirror_share": mirror_share,
            }
        )
        if values["exitance"] > 0.0:
            radiance = {"type": "uniform", "value": values["exitance"] / np.pi}
            properties["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
        mesh = mi.Mesh(f"surface{index}", len(vertices), len(faces), props=properties)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = mi.Float(vertices.ravel())
        parameters["faces"] = mi.UInt32(faces.ravel())
        parameters.update()
        return mesh

    def irradiance(self, walks, seed, start="lamps", sampler="independent", roulette=5):
        """S0 and S1 (frame of incidence) at every point from about `walks` walks each, and the seconds they took.

        `start`: "cosine" sends cosine-distributed rays and counts all that they find; "lamps" samples the lamps at the
        sensor and leaves what the first ray meets of them out.
        """
        begun = time.perf_counter()
        integrator = self.mi.load_dict({"type": "path", "max_depth": -1, "rr_depth": roulette})
        sums = np.zeros((2, len(self.points)))
        launches = -(-walks * len(self.points) // LAUNCH)
        # A square, which every sampler takes as it is, of a multiple of 8, so that blocks are of 64.
        each = (8 * max(1, round(np.sqrt(walks / launches) / 8))) ** 2
        for launch in range(launches):
            sums += self._launch(integrator, each, seed * launches + launch, start, sampler)
        return sums / (launches * each), time.perf_counter() - begun

    def _launch(self, integrator, walks, seed, start, sampler):
        mi, dr = self.mi, self.dr
        count = len(self.points) * walks
        random = mi.load_dict({"type": sampler, "sample_count": walks})
        random.set_samples_per_wavefront(walks)
        random.seed(seed, count)
        sensor = dr.arange(mi.UInt32, count) // dr.opaque(mi.UInt32, walks)
        normal = mi.Vector3f(*(self._column(self.normals, axis, sensor) for axis in range(3)))
        place = mi.Point3f(*(self._column(self.points, axis, sensor) for axis in range(3)))
        place += dr.opaque(mi.Float, self.offset) * normal
        look, weight = self._look(random, place, normal)
        ray = mi.RayDifferential3f(place, look)
        s0 = mi.Float(0.0)
        if start == "lamps":
            s0 += self._from_lamps(random, place, normal)
        found, _, _ = integrator.sample(self.scene, random, ray)
        # The light travels against the ray.
        travels = -look
        turned = mi.mueller.rotate_stokes_basis(
            travels, mi.mueller.stokes_basis(travels), self._s_axis(travels, normal)
        )
        stokes = [found[row, 0][0] for row in range(4)]
        if start == "lamps":
            met = self.scene.ray_intersect(ray)
            stokes[0] -= met.emitter(self.scene).eval(met)[0, 0][0]
        s0 += dr.pi * weight * stokes[0]
        s1 = dr.pi * weight * sum(turned[1, column] * stokes[column] for column in range(1, 4))
        return self._sums([s0, s1])

    def _look(self, random, place, normal):
        """Direction of the first ray, and the cosine over π over its density."""
        cosine = self.mi.warp.square_to_cosine_hemisphere(random.next_2d())
        return self.mi.Frame3f(normal).to_world(cosine), self.mi.Float(1.0)

    def _column(self, table, axis, sensor):
        column = self.mi.Float(np.ascontiguousarray(table[:, axis], np.float32))
        return self.dr.gather(self.mi.Float, column, sensor)

    def _from_lamps(self, random, place, normal):
        """Irradiance from one place on one lamp."""
        mi, dr = self.mi, self.dr
        here = dr.zeros(mi.SurfaceInteraction3f, dr.width(place))
        here.p, here.n, here.t = place, mi.Normal3f(normal), 0.0
        towards, radiance = self.scene.sample_emitter_direction(here, random.next_2d(), True)
        cos = dr.maximum(0.0, dr.dot(towards.d, normal))
        return dr.select(towards.pdf > 0.0, cos * radiance[0, 0][0], 0.0)

    def _s_axis(self, travels, normal):
        axis = self.dr.cross(travels, normal)
        length = self.dr.squared_norm(axis)
        along = self.mi.mueller.stokes_basis(travels)
        return self.dr.select(length > 1e-12, axis * self.dr.rsqrt(length), along)

    def _sums(self, values):
        """Sums a sensor, blockwise; all outputs in one evaluation, or each would trace the walks anew."""
        partial = [self.dr.block_sum(value, BLOCK) for value in values]
        self.dr.eval(partial)
        shape = (len(self.points), -1)
        return np.array([np.array(part, np.float64).reshape(shape).sum(axis=1) for part in partial])
