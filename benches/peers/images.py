"""The paper's room at a = 1 by images alone: exact values, made without chance and without malus.

All walls are mirrors of glass, so light reaches a point of the floor straight from the disc or from one of its images in
the unfolded cube. Each image is integrated by quadrature; along each line the walls that it crosses reflect by Fresnel's
formulae, with the Stokes vector turned from plane to plane of incidence, and the black lamp itself blocks what meets it.
"""

import numpy as np

INDEX = 1.5
RADIUS = 0.05
EXITANCE = 1.0
# Reflections near normal incidence keep 4 % each: orders beyond these add less than 1e-7 of the whole.
SIDEWAYS = 7
UPWARDS = 4
RINGS, SPOKES = 12, 36


def floor_illuminance(point):
    """S0, S1 (frame of incidence) and S0 of the scalar model at `point` = (x, y) on the floor."""
    total = np.zeros(3)
    for i in range(-SIDEWAYS, SIDEWAYS + 1):
        for j in range(-SIDEWAYS, SIDEWAYS + 1):
            for m in range(UPWARDS + 1):
                if abs(i) + abs(j) + m <= SIDEWAYS:
                    total += _image(point, i, j, m)
    return total


def _image(point, i, j, m):
    """What the image of the lamp in the cube (i, j, 2m) of the unfolded room sends to the point."""
    offsets, areas = _disc()
    places = np.column_stack([offsets + (i + 0.5, j + 0.5), np.full(len(offsets), 1.0 + 2 * m)])
    origin = np.array([*point, 0.0])
    line = places - origin
    distance = np.linalg.norm(line, axis=1)
    look = line / distance[:, None]
    coupling = EXITANCE / np.pi * look[:, 2] ** 2 / distance**2 * areas
    axes, blocked = _walls(origin, line, i, j, m)
    stokes, scalar = _sent_on(look, axes)
    weights = np.where(blocked, 0.0, coupling)
    return np.array([weights @ stokes[:, 0], weights @ stokes[:, 1], weights @ scalar])


def _disc():
    """Points and areas of a Gauss rule over the lamp."""
    nodes, weights = np.polynomial.legendre.leggauss(RINGS)
    squares = (nodes + 1) / 2
    angles = 2 * np.pi * (np.arange(SPOKES) + 0.5) / SPOKES
    radii = RADIUS * np.sqrt(squares)
    offsets = np.stack([np.outer(radii, np.cos(angles)), np.outer(radii, np.sin(angles))], axis=-1)
    areas = np.repeat(weights / 2, SPOKES) * np.pi * RADIUS**2 / SPOKES
    return offsets.reshape(-1, 2), areas


def _walls(origin, line, i, j, m):
    """The axes of the walls that each line crosses on its way from the floor, and whether the lamp is in its way."""
    crossings, axes = [], []
    blocked = np.zeros(len(line), bool)
    for axis, planes in ((0, _planes(i)), (1, _planes(j)), (2, range(1, 2 * m + 1))):
        for plane in planes:
            share = (plane - origin[axis]) / line[:, axis]
            crossings.append(share)
            axes.append(axis)
            if axis == 2 and plane % 2 == 1:
                at = _folded(origin + share[:, None] * line)
                blocked |= np.hypot(at[:, 0] - 0.5, at[:, 1] - 0.5) < RADIUS
    if not crossings:
        return np.zeros((len(line), 0), int), blocked
    order = np.argsort(np.array(crossings), axis=0)
    return np.array(axes)[order].T, blocked


def _planes(cell):
    return range(1, cell + 1) if cell > 0 else range(0, cell, -1)


def _folded(places):
    inside = np.mod(places, 2.0)
    return np.where(inside > 1.0, 2.0 - inside, inside)


def _sent_on(look, axes):
    """Stokes vector at the sensor of unpolarised light of unit strength, and its strength in the scalar model."""
    count = len(look)
    look = look.copy()
    # The chain as a matrix from the lamp's light to the sensor's frame, built from the sensor outwards.
    chain = np.broadcast_to(np.eye(4), (count, 4, 4)).copy()
    scalar = np.ones(count)
    frame = _across(-look, np.broadcast_to([0.0, 0.0, 1.0], look.shape))
    rows = np.arange(count)
    for step in range(axes.shape[1]):
        axis = axes[:, step]
        normal = np.zeros_like(look)
        normal[rows, axis] = -np.sign(look[rows, axis])
        # Light leaves the wall along -look; s is the same vector before and after.
        s = _across(-look, normal)
        chain = chain @ _turned(-look, s, frame)
        matrix, mean = _reflection(np.abs(look[rows, axis]))
        chain = chain @ matrix
        scalar *= mean
        look[rows, axis] *= -1.0
        frame = _across(-look, normal)
    return chain[:, :, 0], scalar


def _across(direction, normal):
    """The s axis of a beam at a surface; any axis across the beam where it falls along the normal."""
    axis = np.cross(direction, normal)
    length = np.linalg.norm(axis, axis=1, keepdims=True)
    other = np.cross(direction, np.roll(normal, 1, axis=1))
    other /= np.linalg.norm(other, axis=1, keepdims=True)
    return np.where(length > 1e-9, axis / np.maximum(length, 1e-9), other)


def _turned(direction, before, after):
    """Rotators from the axis `before` to `after` (eq. 3)."""
    c = np.sum(before * after, axis=1)
    s = np.sum(np.cross(before, after) * direction, axis=1)
    cos, sin = c * c - s * s, 2 * c * s
    matrix = np.zeros((len(c), 4, 4))
    matrix[:, 0, 0] = matrix[:, 3, 3] = 1.0
    matrix[:, 1, 1] = matrix[:, 2, 2] = cos
    matrix[:, 1, 2], matrix[:, 2, 1] = sin, -sin
    return matrix


def _reflection(cos):
    """Matrix of a reflection by glass (eq. 7 with the signed product), and its reflectance of unpolarised light."""
    cos_inside = np.sqrt(1 - (1 - cos * cos) / INDEX**2)
    r_s = (cos - INDEX * cos_inside) / (cos + INDEX * cos_inside)
    r_p = (INDEX * cos - cos_inside) / (INDEX * cos + cos_inside)
    matrix = np.zeros((len(cos), 4, 4))
    matrix[:, 0, 0] = matrix[:, 1, 1] = (r_s**2 + r_p**2) / 2
    matrix[:, 0, 1] = matrix[:, 1, 0] = (r_s**2 - r_p**2) / 2
    matrix[:, 2, 2] = matrix[:, 3, 3] = r_s * r_p
    return matrix, (r_s**2 + r_p**2) / 2
