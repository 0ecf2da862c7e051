"""Eq. 21 as a BSDF of Mitsuba 3: a share a of mirror-like Fresnel reflection, the rest scattered by Lambert's law.

Written here because Mitsuba's own `blendbsdf` is biased where one of its parts is a mirror. The transport is Mitsuba's.
"""


def register(mi, dr):
    """Makes the plugin `mixture` known to the current, polarised variant."""

    class Mixture(mi.BSDF):
        """Keys: rho, a, n, k; two_sided; scalar (reflect by the mean of Rs and Rp, unpolarised);
        mirror_share: chance of the mirror where both parts exist, or 0 for shares in proportion to what they reflect.
        """

        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.a = float(props["a"])
            self.diffuse = (1.0 - self.a) * float(props["rho"])
            self.index = (float(props["n"]), float(props["k"]))
            self.two_sided = bool(props["two_sided"])
            self.scalar = bool(props["scalar"])
            self.mirror_share = float(props["mirror_share"])
            sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            mirror = mi.BSDFFlags.DeltaReflection | sides
            lambert = mi.BSDFFlags.DiffuseReflection | sides
            self.m_components = [mirror, lambert]
            self.m_flags = mirror | lambert

        def sample(self, context, si, sample1, sample2, active=True):
            chance = self._chance_of_mirror(si)
            mirrored = sample1 < chance
            cosine = mi.warp.square_to_cosine_hemisphere(sample2)
            cosine.z = dr.mulsign(cosine.z, mi.Frame3f.cos_theta(si.wi))
            sampled = dr.zeros(mi.BSDFSample3f)
            sampled.wo = dr.select(mirrored, mi.reflect(si.wi), cosine)
            sampled.pdf = dr.select(
                mirrored, chance, (1.0 - chance) * dr.abs(cosine.z) * dr.inv_pi
            )
            sampled.eta = 1.0
            sampled.sampled_type = dr.select(
                mirrored,
                mi.UInt32(+mi.BSDFFlags.DeltaReflection),
                mi.UInt32(+mi.BSDFFlags.DiffuseReflection),
            )
            sampled.sampled_component = dr.select(mirrored, mi.UInt32(0), mi.UInt32(1))
            weight = dr.select(
                mirrored,
                self._mirror(si) * (self.a / dr.maximum(chance, 1e-12)),
                mi.mueller.depolarizer(
                    mi.Color1f(self.diffuse / dr.maximum(1.0 - chance, 1e-12))
                ),
            )
            reflects = self._reflects(si, active) & (sampled.pdf > 0.0)
            return sampled, dr.select(reflects, weight, mi.Spectrum(0.0))

        def eval(self, context, si, wo, active=True):
            value = self.diffuse * dr.inv_pi * dr.abs(mi.Frame3f.cos_theta(wo))
            return mi.mueller.depolarizer(
                mi.Color1f(dr.select(self._one_side(si, wo, active), value, 0.0))
            )

        def pdf(self, context, si, wo, active=True):
            density = (1.0 - self._chance_of_mirror(si)) * dr.inv_pi
            density *= dr.abs(mi.Frame3f.cos_theta(wo))
            return dr.select(self._one_side(si, wo, active), density, 0.0)

        def eval_pdf(self, context, si, wo, active=True):
            return self.eval(context, si, wo, active), self.pdf(context, si, wo, active)

        def traverse(self, callback):
            pass

        def to_string(self):
            return f"Mixture[a={self.a}, index={self.index}]"

        def _reflects(self, si, active):
            cos = mi.Frame3f.cos_theta(si.wi)
            lit = cos != 0.0 if self.two_sided else cos > 0.0
            return mi.Bool(active) & lit

        def _one_side(self, si, wo, active):
            same = mi.Frame3f.cos_theta(si.wi) * mi.Frame3f.cos_theta(wo) > 0.0
            return self._reflects(si, active) & same

        def _chance_of_mirror(self, si):
            if self.a == 0.0:
                return mi.Float(0.0)
            if self.diffuse == 0.0:
                return mi.Float(1.0)
            if self.mirror_share > 0.0:
                return mi.Float(self.mirror_share)
            cos = dr.abs(mi.Frame3f.cos_theta(si.wi))
            matrix = mi.mueller.specular_reflection(cos, mi.Complex2f(*self.index))
            # The most that any state of light keeps: max(Rs, Rp).
            most = self.a * (matrix[0, 0] + dr.abs(matrix[0, 1]))
            return most / (most + self.diffuse)

        def _mirror(self, si):
            """Mueller matrix of the reflection towards si.wi, in the implicit bases of Mitsuba."""
            cos = dr.abs(mi.Frame3f.cos_theta(si.wi))
            matrix = mi.mueller.specular_reflection(cos, mi.Complex2f(*self.index))
            if self.scalar:
                return mi.mueller.depolarizer(mi.Color1f(matrix[0, 0]))
            arriving, leaving = -mi.reflect(si.wi), si.wi
            before, after = _s_axis(arriving), _s_axis(leaving)
            matrix = mi.mueller.rotate_mueller_basis(
                matrix,
                arriving,
                before,
                mi.mueller.stokes_basis(arriving),
                leaving,
                after,
                mi.mueller.stokes_basis(leaving),
            )
            return mi.Spectrum([[mi.Color1f(matrix[i, j]) for j in range(4)] for i in range(4)])

    def _s_axis(direction):
        """Across the plane of incidence; at normal incidence any axis across the beam serves."""
        axis = mi.Vector3f(-direction.y, direction.x, 0.0)
        length = dr.squared_norm(axis)
        return dr.select(length > 1e-14, axis * dr.rsqrt(length), mi.Vector3f(1.0, 0.0, 0.0))

    mi.register_bsdf("mixture", Mixture)
