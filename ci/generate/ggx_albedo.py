"""Writes common/materials/ggx_albedo_table.h: directional albedo of the GGX lobe with height-correlated Smith masking.

usage: python3 ci/generate/ggx_albedo.py > common/materials/ggx_albedo_table.h     (needs numpy; half a minute)
Entry (row r, column c): roughness (r / (N - 1))^2, alpha = roughness^2; cosine (c / (N - 1))^2. Quadrature over visible normals
(Heitz, JCGT 7(4), 2018): E = mean of G2 / G1; B = the share that carries Schlick's (1 - v.h)^5."""
import numpy as np

N = 32


def directional_albedo(mu, alpha, n=96):
    x, w = np.polynomial.legendre.leggauss(n)
    radius, weight = (x + 1) / 2, w / 2
    phi = 2 * np.pi * (np.arange(4 * n) + 0.5) / (4 * n)
    r, p = np.meshgrid(radius, phi, indexing="ij")
    weights = (weight * 2 * radius)[:, None] / (4 * n) * np.ones_like(p)
    view = np.array([np.sqrt(max(0.0, 1 - mu * mu)), 0.0, mu])
    stretched = view * [alpha, alpha, 1]
    stretched /= np.linalg.norm(stretched)
    length2 = stretched[0] ** 2 + stretched[1] ** 2
    t1 = np.array([0.0, 1.0, 0.0]) if length2 < 1e-20 else np.array([-stretched[1], stretched[0], 0]) / np.sqrt(length2)
    t2 = np.cross(stretched, t1)
    a, b = r * np.cos(p), r * np.sin(p)
    s = 0.5 * (1 + stretched[2])
    b = (1 - s) * np.sqrt(np.maximum(0, 1 - a * a)) + s * b
    c = np.sqrt(np.maximum(0, 1 - a * a - b * b))
    normal = a[..., None] * t1 + b[..., None] * t2 + c[..., None] * stretched
    half = normal * [alpha, alpha, 1]
    half[..., 2] = np.maximum(half[..., 2], 1e-12)
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    cosine = half @ view
    light = 2 * cosine * half[..., 2] - mu
    smith = lambda z: (np.sqrt(1 + alpha**2 * (1 - z * z) / np.maximum(z * z, 1e-20)) - 1) / 2
    value = np.where(light > 0, (1 + smith(mu)) / (1 + smith(mu) + smith(np.maximum(light, 1e-9))), 0) * weights
    return value.sum(), (value * np.clip(1 - cosine, 0, 1) ** 5).sum()


def average(row):
    """2 * integral of mu * f(mu) over [0, 1] for f linear in sqrt(mu) between the entries: exactly what the kernels interpolate."""
    t = np.linspace(0, 1, N)
    x, w = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for k in range(N - 1):
        s = t[k] + (x + 1) / 2 * (t[k + 1] - t[k])
        f = row[k] + (row[k + 1] - row[k]) * (s - t[k]) * (N - 1)
        total += (w / 2 * f * 2 * s**2 * 2 * s).sum() * (t[k + 1] - t[k])
    return total


table = np.zeros((N, N, 2))
for r in range(N):
    for c in range(N):
        mu, alpha = (c / (N - 1)) ** 2, (r / (N - 1)) ** 4
        table[r, c] = directional_albedo(max(mu, 1e-4), max(alpha, 1e-5))
averages = [[average(table[r, :, k]) for k in range(2)] for r in range(N)]


def rows(values):
    text = [f"{v:.7f}f" for v in values]
    return ",\n".join("    " + ", ".join(text[k : k + 8]) for k in range(0, len(text), 8))


print("// Written by ci/generate/ggx_albedo.py, which says what it holds and how it was integrated.")
print("#pragma once\n")
print("// clang-format off")
print(f"#define GGX_ALBEDO_SIZE {N}")
for name, values in (("ggx_albedo_all", table[..., 0].ravel()), ("ggx_albedo_schlick", table[..., 1].ravel()),
                     ("ggx_average_all", [a[0] for a in averages]), ("ggx_average_schlick", [a[1] for a in averages])):
    print(f"\nCONSTANT float {name}[{len(values)}] = {{\n{rows(values)}\n}};")
print("// clang-format on")
