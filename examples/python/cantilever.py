"""The rows of hexahedra of the table "Cantilever" in docs/results/accuracy.md, computed from Python.

    python cantilever.py ../../docs/results/accuracy.md

Prints the table, and fails when a deflection differs from the page by more than its last digit.
"""
import re
import sys

import numpy as np
import palpate

LENGTH, SIDE, FORCE, CONVERGED = 1.0, 0.2, 4.0, 0.0101745


def hex8_box(nx, ny, nz):
    """Nodes and cells of a box; node (i, j, k) is number i + (nx + 1) (j + (ny + 1) k)."""
    i, j, k = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), np.arange(nz + 1), indexing="ij")
    number = i + (nx + 1) * (j + (ny + 1) * k)
    positions = np.empty((number.size, 3))
    positions[number.ravel()] = np.column_stack(
        [i.ravel() * LENGTH / nx, j.ravel() * SIDE / ny, k.ravel() * SIDE / nz])
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = np.column_stack([number[a:a + nx, b:b + ny, c:c + nz].ravel() for a, b, c in corners])
    return positions, cells


def mean_deflection(element, n):
    """Mean over the loaded end, weighted as the traction is."""
    positions, cells = hex8_box(5 * n, n, n)
    mesh = palpate.Mesh(positions, cells)
    end = np.flatnonzero(positions[:, 0] > LENGTH * (1 - 1e-9))
    mesh.add_group("clamp", np.flatnonzero(positions[:, 0] == 0.0))
    mesh.add_group("end", end)
    scene = palpate.Scene().fix("clamp").traction("end", (0.0, 0.0, -FORCE / SIDE**2)).touch("end")
    beam = palpate.Tissue(mesh, scene, f"{element}/linear/sparse_cholesky",
                          [palpate.Material(youngs_modulus=1e6, poisson_ratio=0.3)])
    on_edge = [(positions[end, c] < 1e-9 * SIDE) | (positions[end, c] > SIDE * (1 - 1e-9)) for c in (1, 2)]
    weights = np.where(on_edge[0], 0.5, 1.0) * np.where(on_edge[1], 0.5, 1.0)
    return len(positions), -np.average(beam.displacement()[end, 2], weights=weights)


def main(page):
    text = open(page, encoding="utf-8").read()
    text = text[text.index("## Cantilever"):]
    wrong = 0
    print("| element | cells | nodes | deflection [m] | error [%] | page |\n|---|---|---|---|---|---|")
    for element, name in (("hex8", "Hex8"), ("mean_dilatation_hex8", "`MeanDilatation<Hex8>`")):
        for n in (2, 4, 8):
            nodes, tip = mean_deflection(element, n)
            cells = f"{5 * n} x {n} x {n}"
            row = re.search(re.escape(f"| {name} | {cells} | {nodes} | ") + r"([0-9.]+) \|", text)
            expected = float(row.group(1)) if row else float("nan")
            agrees = abs(tip - expected) < 1.01e-8
            wrong += not agrees
            print(f"| {name} | {cells} | {nodes} | {tip:.8f} | {100 * (tip / CONVERGED - 1):+.3g} | "
                  f"{'agrees' if agrees else f'has {expected:.8f}'} |")
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
