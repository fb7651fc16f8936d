"""Tests of the module: views without copies, other threads run, Ctrl-C, refusals, stubs.

    python test_palpate.py organ.msh
"""
import ast
import json
import os
import pathlib
import signal
import sys
import threading
import time
import unittest

import numpy as np
import palpate

ORGAN = sys.argv.pop(1)
POLICY = "smoothed_tet4/linear/condensed"
LIVER = palpate.Material(youngs_modulus=5e3, poisson_ratio=0.45, density=1060.0)


def organ(policy=POLICY, **options):
    mesh = palpate.Mesh.read(ORGAN)
    return palpate.Tissue(mesh, palpate.Scene().fix("ligament").touch("front", radius=4e-3), policy, [LIVER], **options)


class Organ(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.organ = organ()

    def test_views(self):
        session = palpate.Session(self.organ, [palpate.Sphere(4e-3)])
        vertices, force = session.vertices, session.force()
        self.assertFalse(vertices.flags.owndata or force.flags.owndata)
        self.assertEqual(vertices.dtype, np.float32)
        self.assertTrue(np.shares_memory(vertices, session.vertices))
        session.read_surface()
        rest = vertices.copy()
        for k in range(300):
            session.tick(-0.031, -0.032, 0.060 - 0.022 * min(k, 200) / 200, 1e-3 * k)
        self.assertGreater(np.linalg.norm(force), 0.01)
        self.assertTrue(np.array_equal(force, session.force()))
        session.read_surface()  # into the view that was taken before
        self.assertGreater(np.abs(vertices - rest).max(), 1e-3)
        self.assertLess(np.abs(np.linalg.norm(session.normals, axis=1) - 1).max(), 1e-4)
        self.assertLess(session.triangles.max(), len(vertices))
        del session
        self.assertTrue(np.isfinite(vertices).all() and np.isfinite(force).all())  # views keep their memory

    def test_report(self):
        report = json.loads(self.organ.report_json())
        self.assertEqual(report["policy"], POLICY)
        self.assertEqual(report["nodes"], 2272)
        self.assertEqual(self.organ.displacement().shape, (2272, 3))

    def test_other_threads_run_during_a_run(self):
        session = palpate.Session(self.organ, [palpate.Sphere(4e-3)])
        n = 100000
        done, counted = threading.Event(), []

        def count():
            counts = 0
            while not done.is_set():
                counts += 1
                time.sleep(1e-3)
            counted.append(counts)

        thread = threading.Thread(target=count)
        thread.start()
        session.run(np.tile([-0.031, -0.032, 0.038], (n, 1)), 1e-3 * np.arange(n))
        done.set()
        thread.join()
        self.assertGreater(counted[0], 20)

    def test_two_tools(self):
        path = np.array([(-0.031, -0.032, 0.060 - 0.022 * min(k, 200) / 200) for k in range(300)])
        away = np.array([0.0, 0.0, 0.1])
        times = 1e-3 * np.arange(300)
        session = palpate.Session(self.organ, [palpate.Sphere(4e-3)])
        alone = session.run(path, times)
        np.testing.assert_array_equal(session.run(path[:0], []), np.empty((2, 0, 3)))
        del session
        both = np.stack([path, np.tile(away, (300, 1))], axis=1)
        session = palpate.Session(self.organ, [palpate.Sphere(4e-3), palpate.Sphere(4e-3)])
        together = session.run(both, times)
        self.assertEqual(together[0].shape, (300, 2, 3))
        self.assertGreater(np.linalg.norm(alone[1][-1]), 0.01)
        for one, two in zip(alone, together):
            np.testing.assert_allclose(two[:, 0], one, atol=1e-9)
            self.assertEqual(np.abs(two[:, 1]).max(), 0.0)
        session.reset()
        for k in range(300):
            statuses = session.tick_tools(both[k], times[k])
        np.testing.assert_array_equal(session.contact_force(0), together[1][-1, 0])
        self.assertEqual(statuses, [session.status(0), session.status(1)])
        for wrong in (path, both[:, :1], both[:, :, :2]):
            with self.assertRaises(ValueError):
                session.run(wrong, times)
        with self.assertRaises(ValueError):
            session.tick_tools(path[0], 0.0)
        with self.assertRaises(ValueError):
            session.tick(0.0, 0.0, 0.1, 0.0)

    def test_one_session(self):
        first = palpate.Session(self.organ, [palpate.Sphere()])
        with self.assertRaises(palpate.SetupError) as refused:
            palpate.Session(self.organ, [palpate.Sphere()])
        self.assertEqual(refused.exception.kind, "invalid_argument")
        del first


class Setup(unittest.TestCase):
    def test_progress_and_cancel(self):
        stages = set()
        organ(progress=lambda stage, fraction: stages.add(stage))
        self.assertIn("factorisation", stages)
        with self.assertRaises(palpate.SetupError) as refused:
            organ(progress=lambda stage, fraction: False)
        self.assertEqual(refused.exception.kind, "cancelled")
        with self.assertRaises(ZeroDivisionError):
            organ(progress=lambda stage, fraction: 1 / 0)

    def test_ctrl_c_cancels(self):
        def interrupt(stage, fraction):
            if stage == "factorisation":
                os.kill(os.getpid(), signal.SIGINT)

        # A shell starts background jobs with this signal ignored, and Python then installs no handler.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        with self.assertRaises(KeyboardInterrupt):
            organ(progress=interrupt)

    def test_refusals(self):
        with self.assertRaises(palpate.SetupError) as refused:
            organ("tet4/linear/nonsense")
        self.assertIn("tet4/linear/condensed", refused.exception.hint)
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 0.01
        mesh = palpate.Mesh(positions, [[1, 0, 2, 3]])
        mesh.add_group("base", [0, 1, 2])
        mesh.add_group("tip", [3])
        with self.assertRaises(palpate.SetupError) as refused:
            palpate.Tissue(mesh, palpate.Scene().fix("base").touch("surface"), "tet4/linear/condensed", [LIVER])
        self.assertEqual((refused.exception.kind, refused.exception.ids), ("inverted_element", [0]))
        with self.assertRaises(palpate.SetupError) as refused:
            mesh.add_group("outside", [7])
        self.assertEqual(refused.exception.ids, [7])
        with self.assertRaises(ValueError):
            palpate.Mesh(positions.ravel(), [[0, 1, 2, 3]])

    def test_arrays_by_type(self):
        """Numbers of every type give the same mesh, or are refused: none is changed by a cast."""
        positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        cells = np.array([[0, 1, 2, 3]])
        integers = [np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64]
        for kind in integers + [np.float16, np.float32, np.float64, np.longdouble]:
            self.assertEqual(palpate.Mesh(positions.astype(kind), cells).node_count, 4)
        for kind in integers:
            for order in ("<", ">"):
                ids = np.array([2, 3], dtype=np.dtype(kind).newbyteorder(order))
                mesh = palpate.Mesh(positions, cells.astype(ids.dtype), 0 * ids[:1])
                mesh.add_group("these", ids)
                mesh.add_group("strided", np.arange(8).astype(kind)[::2][:2])
        mesh.add_group("no node", [])
        for kind in (bool, np.float32, np.float64, np.longdouble, np.complex128, object, "U1", "M8[s]"):
            wrong = np.array([1, 0, 1, 0]).astype(kind)
            with self.subTest(kind):
                with self.assertRaises(TypeError):
                    mesh.add_group("wrong", wrong)
                with self.assertRaises(TypeError):
                    palpate.Mesh(positions, wrong.reshape(1, 4))
                with self.assertRaises(TypeError):
                    palpate.Mesh(positions, cells, wrong[:1])
        for kind in (bool, np.complex128, object, "U1"):
            with self.subTest(kind), self.assertRaises(TypeError):
                palpate.Mesh(positions.astype(kind), cells)
        for large in (2**32 + 3, 2**31, -2**31 - 1, 2**63):
            with self.subTest(large), self.assertRaises(palpate.SetupError) as refused:
                mesh.add_group("large", np.array([large, large]))
            self.assertEqual((refused.exception.kind, refused.exception.ids), ("index_out_of_range", [large]))
            with self.subTest(large), self.assertRaises(palpate.SetupError):
                palpate.Mesh(positions, np.array([4 * [large]]))

    def test_policies(self):
        self.assertIn(POLICY, palpate.policies())
        self.assertEqual(palpate.status_names(2), ["Saturated"])


def box(nodes_per_cell):
    """A box of 60 x 50 x 40 mm, fixed at the bottom: positions and cells of 4, 8, 10 or 20 nodes."""
    n = np.array([6, 5, 4])
    i, j, k = (a.ravel() for a in np.meshgrid(*(np.arange(m + 1) for m in n), indexing="ij"))
    positions = 0.01 * np.column_stack([i, j, k]) - [0.03, 0.025, 0.0]
    corner = np.arange(len(i)).reshape(n + 1)
    steps = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = np.column_stack([corner[a:a + n[0], b:b + n[1], c:c + n[2]].ravel() for a, b, c in steps])
    if nodes_per_cell in (4, 10):  # six tetrahedra along the diagonal of a cube
        parts = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
        cells = np.concatenate([cells[:, part] for part in parts])
    edges = {10: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
             20: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
    if nodes_per_cell in edges:
        ends = np.sort(np.stack([cells[:, edge] for edge in edges[nodes_per_cell]], axis=1), axis=2)
        unique, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
        cells = np.column_stack([cells, len(positions) + number.reshape(len(cells), -1)])
        positions = np.concatenate([positions, positions[unique].mean(axis=1)])
    return positions, cells


class Policies(unittest.TestCase):
    """Every composition of the library feels about the same box."""

    def press(self, policy):
        element = policy.split("/")[0]
        positions, cells = box({"tet4": 4, "smoothed_tet4": 4, "tet10": 10, "hex20": 20}.get(element, 8))
        mesh = palpate.Mesh(positions, cells)
        mesh.add_group_in_box("bottom", (-1, -1, -1), (1, 1, 1e-6))
        mesh.add_group_in_box("top", (-1, -1, 0.04 - 1e-6), (1, 1, 1))
        tissue = palpate.Tissue(mesh, palpate.Scene().fix("bottom").touch("top"), policy, [LIVER], quasi_static=True)
        moves = "quasi_newton" in policy
        session = palpate.Session(tissue, [palpate.Sphere(12e-3)], manual_work=moves)
        for k in range(150):
            session.tick(1e-3, -2e-3, 0.054 - 4e-5 * min(k, 100), 1e-3 * k)
            if moves:
                session.work()
        exact = 0
        for k in range(150, 300):  # where columns come from a background thread, the first forces are approximate
            exact = 0 if "DegradedModel" in palpate.status_names(session.status()) else exact + 1
            if exact == 3:
                break
            time.sleep(0.02)
            session.tick(1e-3, -2e-3, 0.050, 1e-3 * k)
        session.read_surface()
        self.assertLess(session.triangles.max(), len(session.vertices))
        return session.contact_force()[2]

    def test_all(self):
        expected = self.press("hex20/linear/condensed")
        forces = {policy: self.press(policy) for policy in palpate.policies()}
        self.assertEqual(len(forces), 31)
        for policy, force in forces.items():
            with self.subTest(policy):
                stiff = policy.startswith(("tet4/", "hex8/"))  # these lock
                self.assertLess(abs(force / expected - 1), 1.0 if stiff else 0.25)


class Stubs(unittest.TestCase):
    def test_stubs_list_what_there_is(self):
        stubs = ast.parse(pathlib.Path(palpate.__file__).with_name("_palpate.pyi").read_text(encoding="utf-8"))
        for node in stubs.body:
            if not isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                continue
            there = getattr(palpate, node.name)
            for member in getattr(node, "body", []):
                name = member.name if isinstance(member, ast.FunctionDef) else getattr(
                    getattr(member, "target", None), "id", None)
                if isinstance(node, ast.ClassDef) and name and node.name != "SetupError":
                    self.assertTrue(hasattr(there, name), f"{node.name}.{name}")
        listed = {node.name: node for node in stubs.body if isinstance(node, ast.ClassDef)}
        for name in ("Mesh", "Scene", "Tissue", "Session"):
            members = {getattr(m, "name", None) or m.target.id for m in listed[name].body
                       if isinstance(m, (ast.FunctionDef, ast.AnnAssign))}
            self.assertEqual({m for m in dir(getattr(palpate, name)) if not m.startswith("_")},
                             {m for m in members if not m.startswith("_")})


if __name__ == "__main__":
    unittest.main()
