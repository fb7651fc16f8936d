"""Presses a sphere into the organ of the examples, as tests/c/press.c does, and prints the same lines.

    python press.py organ.msh
"""
import struct
import sys
import time

import numpy as np
import palpate


def position(i):
    return -127.0 / 4096, (-147.0 * 1024 + 16.0 * i) / (4096.0 * 1024), (246.0 * 1024 - 90.0 * i) / (4096.0 * 1024)


def add_to_hash(value, data):
    for byte in data:
        value = ((value ^ byte) * 1099511628211) % 2**64
    return value


def time_ticks(session, i, tick, ticks=100000):
    """Microseconds per tick at a position of the path, one call per tick."""
    x, y, z = position(i)
    start = time.process_time()
    for k in range(tick, tick + ticks):
        session.tick(x, y, z, 1e-3 * k)
    return 1e6 * (time.process_time() - start) / ticks


def main(path):
    mesh = palpate.Mesh.read(path)
    scene = palpate.Scene().fix("ligament").touch("front")
    liver = palpate.Material(youngs_modulus=5e3, poisson_ratio=0.45, density=1060.0)
    organ = palpate.Tissue(mesh, scene, "smoothed_tet4/linear/condensed", [liver])
    session = palpate.Session(organ, [palpate.Sphere(4e-3)])

    n = 1024
    forces, contact = session.run(np.array([position(i) for i in range(n)]), 1e-3 * np.arange(n))
    value = 14695981039346656037
    for force, contact_force in zip(forces, contact):
        value = add_to_hash(add_to_hash(value, force.tobytes()), contact_force.tobytes())
    pressed = time_ticks(session, 1024, n)
    free = time_ticks(session, 0, n + 100000)
    print(f"hash {value:016x}")
    print("force", *(struct.pack(">d", f).hex() for f in contact[-1]))
    print(f"free_us {free:.3f}\npressed_us {pressed:.3f}")


if __name__ == "__main__":
    main(sys.argv[1])
