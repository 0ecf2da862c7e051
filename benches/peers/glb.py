"""Triangles of a .glb file in world metres, Z up, by the names of their materials."""

import json
import struct

import numpy as np

TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
# (x, y, z) → (x, −z, y)
Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def triangles(path):
    """Arrays (n, 3, 3) of corners, by (material, None); objects that are sensors or left out do not count."""
    document, binary = _chunks(path)
    found = {}
    scene = document["scenes"][document.get("scene", 0)]
    for node in scene["nodes"]:
        _visit(document, binary, node, np.eye(4), found)
    return {(name, None): np.concatenate(parts) for name, parts in found.items()}


def write_without(path, objects, target):
    """Copies a file, its `objects` marked to be left out."""
    document, binary = _chunks(path)
    for node in document["nodes"]:
        if node.get("name") in objects:
            node.setdefault("extras", {})["malus_ignore"] = True
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    target.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def _chunks(path):
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def _visit(document, binary, index, parent, found):
    node = document["nodes"][index]
    place = parent @ _placement(node)
    extras = node.get("extras", {})
    counts = not (
        "malus_sensor" in extras or extras.get("malus_ignore") or node.get("name", "").startswith("SENSOR_")
    )
    if "mesh" in node and counts:
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            name = "(none)"
            if "material" in primitive:
                name = document["materials"][primitive["material"]]["name"]
            found.setdefault(name, []).append(_corners(document, binary, primitive, place))
    for child in node.get("children", []):
        _visit(document, binary, child, place, found)


def _placement(node):
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    place = np.eye(4)
    place[:3, :3] = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    ) * node.get("scale", (1.0, 1.0, 1.0))
    place[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return place


def _corners(document, binary, primitive, place):
    points = _accessor(document, binary, primitive["attributes"]["POSITION"]).astype(float)
    points = (points @ place[:3, :3].T + place[:3, 3]) @ Z_UP.T
    faces = _accessor(document, binary, primitive["indices"]).reshape(-1, 3)
    if np.linalg.det(place[:3, :3]) < 0.0:
        # A mirrored object: what was anticlockwise is clockwise now.
        faces = faces[:, ::-1]
    return points[faces]


def _accessor(document, binary, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    kind, width = TYPES[accessor["componentType"]], WIDTHS[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    if view.get("byteStride", width * kind().nbytes) != width * kind().nbytes:
        raise ValueError("interleaved buffers are not read")
    values = np.frombuffer(binary, kind, accessor["count"] * width, start)
    return values.reshape(-1, width)
