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

    def test_policies(self):
        self.assertIn(POLICY, palpate.policies())
        self.assertEqual(palpate.status_names(2), ["Saturated"])


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
