#!/usr/bin/env -S python3 -B
"""A car-like scene by code: a bright car on a plain floor under a sky with a small sun.

Usage: ci/benchmarks/car.py FOLDER   writes car.gltf and sky.hdr; render with --env FOLDER/sky.hdr
Metres, y up; the picture is uneven: the floor and the sky are quiet, what metal mirrors is not.
"""
import base64
import json
import math
import os
import struct
import sys

SUN = (0.45, 0.72, 0.53)  # direction towards it, near to unit length
SUN_RADIUS = math.radians(1.5)


class Mesh:
    """A grid of points over two parameters from 0 to 1, with smooth normals; row by row."""

    def __init__(self, columns, rows, point):
        self.points, self.normals, self.indices = [], [], []
        step = 1e-4
        for j in range(rows + 1):
            for i in range(columns + 1):
                u, v = i / columns, min(max(j / rows, step), 1 - step)
                self.points.append(point(u, v))
                along = [b - a for a, b in zip(point(u - step, v), point(u + step, v))]
                up = [b - a for a, b in zip(point(u, v - step), point(u, v + step))]
                normal = [along[k - 2] * up[k - 1] - along[k - 1] * up[k - 2] for k in range(3)]
                length = math.hypot(*normal)
                self.normals.append([c / length for c in normal])
        for j in range(rows):
            for i in range(columns):
                a = j * (columns + 1) + i
                b = a + columns + 1
                self.indices += [a, a + 1, b, a + 1, b + 1, b]


def rounded(size, power, centre):
    """The surface |x/a|^p + |y/b|^p + |z/c|^p = 1 about a centre, seen along directions."""

    def point(u, v):
        longitude, latitude = 2 * math.pi * u, math.pi * (v - 0.5)
        direction = (math.cos(latitude) * math.cos(longitude), math.sin(latitude),
                     -math.cos(latitude) * math.sin(longitude))
        reach = sum(abs(d / s) ** power for d, s in zip(direction, size)) ** (-1 / power)
        return [c + reach * d for c, d in zip(centre, direction)]

    return Mesh(160, 80, point)


def ring(centre, radius, thickness):
    """A torus about an axis along z."""

    def point(u, v):
        around, across = 2 * math.pi * u, 2 * math.pi * v
        reach = radius + thickness * math.cos(across)
        return [centre[0] + reach * math.cos(around), centre[1] + reach * math.sin(around),
                centre[2] + thickness * math.sin(across)]

    return Mesh(64, 24, point)


def plane(side):
    return Mesh(1, 1, lambda u, v: [side * (u - 0.5), 0, side * (0.5 - v)])


def material(color, metallic, roughness):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic,
                                     "roughnessFactor": roughness}}


def parts():
    yield "floor", plane(2000), material((0.35, 0.35, 0.34), 0, 1)
    yield "body", rounded((2.1, 0.42, 0.85), 3.2, (0, 0.68, 0)), material((0.85, 0.06, 0.04), 0.8, 0.22)
    yield "cabin", rounded((1.05, 0.42, 0.7), 2.6, (-0.2, 1.1, 0)), material((0.02, 0.02, 0.03), 0, 0.08)
    for x in (-1.3, 1.3):
        for z in (-0.8, 0.8):
            yield "tyre", ring((x, 0.34, z), 0.25, 0.09), material((0.03, 0.03, 0.03), 0, 0.7)
            yield "rim", rounded((0.2, 0.2, 0.07), 2, (x, 0.34, z)), material((0.9, 0.9, 0.92), 1, 0.12)


def write_scene(path):
    data, accessors, views, meshes, materials, nodes = b"", [], [], [], [], []

    def accessor(values, kind, code, component, extra):
        nonlocal data
        packed = struct.pack(f"<{len(values)}{code}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed
        count = len(values) // (3 if kind == "VEC3" else 1)
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count,
                          "type": kind, **extra})
        return len(accessors) - 1

    for name, mesh, look in parts():
        bounds = {"min": [min(p[k] for p in mesh.points) for k in range(3)],
                  "max": [max(p[k] for p in mesh.points) for k in range(3)]}
        primitive = {
            "attributes": {"POSITION": accessor(sum(mesh.points, []), "VEC3", "f", 5126, bounds),
                           "NORMAL": accessor(sum(mesh.normals, []), "VEC3", "f", 5126, {})},
            "indices": accessor(mesh.indices, "SCALAR", "I", 5125, {}), "material": len(materials)}
        nodes.append({"name": name, "mesh": len(meshes)})
        meshes.append({"primitives": [primitive]})
        materials.append({"name": name, **look})
    tilt, turn = math.radians(-12) / 2, math.radians(32) / 2
    nodes.append({"name": "camera", "camera": 0, "translation": [3.7, 1.75, 5.9],
                  "rotation": [math.sin(tilt) * math.cos(turn), math.cos(tilt) * math.sin(turn),
                               -math.sin(tilt) * math.sin(turn), math.cos(tilt) * math.cos(turn)]})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes, "meshes": meshes, "materials": materials, "accessors": accessors,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)


def rgbe(color):
    most = max(color)
    if most < 1e-30:
        return bytes(4)
    mantissa, exponent = math.frexp(most)
    return bytes([min(int(c * mantissa * 256 / most), 255) for c in color] + [exponent + 128])


def write_sky(path, width=1024):
    """Radiance, latitude by longitude; -z in the middle, +x a quarter to the right."""
    height = width // 2
    rows = []
    for j in range(height):
        latitude = math.pi * (0.5 - (j + 0.5) / height)
        y, flat = math.sin(latitude), math.cos(latitude)
        for i in range(width):
            longitude = 2 * math.pi * ((i + 0.5) / width - 0.5)
            x, z = flat * math.sin(longitude), -flat * math.cos(longitude)
            nearness = (x * SUN[0] + y * SUN[1] + z * SUN[2]) / math.hypot(*SUN)
            high = max(y, 0) ** 0.5
            color = [0.75 - 0.5 * high, 0.8 - 0.4 * high, 0.9 - 0.2 * high] if y > 0 else [0.1, 0.1, 0.1]
            if nearness > math.cos(SUN_RADIUS):
                color = [2600, 2400, 2000]
            rows.append(rgbe(color))
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + b"".join(rows))


def write(folder):
    """The scene and its sky: paths of car.gltf and sky.hdr."""
    os.makedirs(folder, exist_ok=True)
    scene, sky = os.path.join(folder, "car.gltf"), os.path.join(folder, "sky.hdr")
    write_scene(scene)
    write_sky(sky)
    return scene, sky


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    print(*write(sys.argv[1]), sep="\n")
