#!/usr/bin/env python3
"""Make organ.msh: the two-lobed, liver-like soft body that ships with palpate.

    python3 make_organ.py [output.msh]      (needs numpy only; about two minutes)

The shape is not taken from any scan or atlas: it is a handful of ellipsoids,
blended together smoothly (see `shape`).  The mesher is self-contained too:

  1. a body-centred cubic (BCC) lattice is laid in a *mapped* space.  The map is
     an inversion in a sphere centred outside the body, over the touchable
     patch.  An inversion is conformal: it changes the size of the lattice
     tetrahedra (small near the patch, growing away from it) but not their
     angles, so the size is graded and the quality is not paid for it;
  2. lattice nodes close to the surface are snapped to it and the tetrahedra
     still crossing the surface are cut ("isosurface stuffing", Labelle and
     Shewchuk 2007), which gives a conforming, watertight boundary;
  3. nodes are moved, the worst tetrahedra first, to raise the quality.
     Boundary nodes only slide along the exact surface;
  4. the physical groups are picked by position and all is written as MSH 2.2.

Everything is deterministic (no clock, no random numbers).
Internally lengths are in millimetres; the file is in metres.

Axes: x from right lobe (-) to left lobe (+), y to the back, z up.
"""
import os
import sys
import numpy as np

# ----------------------------------------------------------------- parameters
H_LATTICE = 4.5                 # lattice cell at the patch centre [mm]
GRADING = 80.0                  # distance of the inversion centre from the patch
TILT = np.array([0.20, 0.0, 0.0])   # ... leaning over the (thin) left lobe
PATCH_DIR = np.array([0.0, -0.62, 0.78])      # where the patch is, seen from
PATCH_FROM = np.array([-31.0, 0.0, 0.0])      # ... this inner point
PATCH_RADIUS = 38.0             # touchable patch [mm]
LESION_DEPTH = 19.0             # centre of the lesion below the patch centre
LESION_RADIUS = 10.0
LIGAMENT_AT = np.array([-18.0, 66.0, 16.0])   # back/top area that holds the body
LIGAMENT_RADIUS = 42.0
SNAP = (0.30, 0.42)             # snapping fraction for long and short edges

# ---------------------------------------------------------------------- shape


def rotation(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = {'x': (1, 2), 'y': (2, 0), 'z': (0, 1)}[axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def ellipsoid(p, centre, radii, r=np.eye(3)):
    """Approximate signed distance to an ellipsoid (negative inside)."""
    q = (p - np.array(centre, float)) @ r / np.array(radii, float)
    k0 = np.sqrt((q * q).sum(-1)) + 1e-12
    k1 = np.sqrt(((q / np.array(radii, float))**2).sum(-1)) + 1e-12
    return k0 * (k0 - 1.0) / k1


def union(a, b, k):
    """Smooth minimum: the two solids blended over a width k."""
    h = np.maximum(k - np.abs(a - b), 0.0) / k
    return np.minimum(a, b) - h**3 * k / 6.0


def carve(a, b, k):
    """Solid a minus solid b, the edge rounded over a width k."""
    return -union(-a, b, k)


def shape(p):
    """Implicit function of the organ, about a signed distance [mm]."""
    ry, rz = (lambda d: rotation('y', d)), (lambda d: rotation('z', d))
    d = ellipsoid(p, (-42, 0, -1), (58, 64, 46), ry(12))              # right lobe
    d = union(d, ellipsoid(p, (-8, 2, 9), (52, 58, 31), ry(12)), 24)  # its slope
    d = union(d, ellipsoid(p, (38, 10, 9), (52, 46, 20), rz(12) @ ry(8)), 24)
    d = union(d, ellipsoid(p, (61, 12, 6), (42, 31, 15), rz(14) @ ry(10)), 20)
    d = carve(d, ellipsoid(p, (24, -62, 0), (13, 56, 90), rz(-10)), 26)   # notch
    d = carve(d, ellipsoid(p, (17, -5, 52), (11, 90, 21), rz(-10)), 20)    # groove
    d = carve(d, ellipsoid(p, (5, -5, -92), (100, 75, 68)), 26)     # hollow below
    return d


def gradient(p, h=1e-3):
    o = h * np.eye(3)
    v = shape(p[..., None, :] + np.concatenate([o, -o]))
    return (v[..., :3] - v[..., 3:]) / (2 * h)


def project(p, steps=6):
    """Bring points near the surface onto it (Newton along the gradient)."""
    for _ in range(steps):
        g = gradient(p)
        p = p - (shape(p) / np.maximum((g * g).sum(-1), 1e-6))[..., None] * g
    return p


def on_ray(origin, direction):
    """The surface point on a ray that starts inside."""
    lo, hi = 0.0, 200.0
    for _ in range(60):
        mid = 0.5 * (lo + hi)
        lo, hi = (mid, hi) if shape(origin + mid * direction) < 0 else (lo, mid)
    return origin + lo * direction


# -------------------------------------------------------------------- quality
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # outward


def det6(x):
    """6 x volume of tetrahedra x[..., 4, 3], > 0 if well oriented."""
    e = x[..., 1:, :] - x[..., :1, :]
    return (e[..., 0, :] * np.cross(e[..., 1, :], e[..., 2, :])).sum(-1)


def face_normals(x):
    """Outward area vectors (times two) of the faces opposite nodes 0..3."""
    a, b, c, d = (x[..., i, :] for i in range(4))
    return np.stack([np.cross(c - b, d - b), np.cross(d - a, c - a),
                     np.cross(b - a, d - a), np.cross(c - a, b - a)], -2)


def dihedral_cosines(x):
    n = face_normals(x)
    n = n / np.maximum(np.sqrt((n * n).sum(-1, keepdims=True)), 1e-30)
    return -np.stack([(n[..., i, :] * n[..., j, :]).sum(-1)
                      for i, j in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))], -1)


def radius_ratio(x):
    """3 x inradius / circumradius: 1 for the regular tetrahedron, <= 0 if bad."""
    d = det6(x)
    e = x[..., 1:, :] - x[..., :1, :]
    u, v, w = e[..., 0, :], e[..., 1, :], e[..., 2, :]
    s = ((u * u).sum(-1)[..., None] * np.cross(v, w) + (v * v).sum(-1)[..., None] * np.cross(w, u)
         + (w * w).sum(-1)[..., None] * np.cross(u, v))
    area = 0.5 * np.sqrt((face_normals(x)**2).sum(-1)).sum(-1)
    # r = 3V/area = d/(2 area),  R = |s| / (2 d)
    return 3.0 * d * np.abs(d) / np.maximum(area * np.sqrt((s * s).sum(-1)), 1e-30)


def score(x):
    """What is optimised, per tetrahedron: radius ratio, held back by the
    smallest and the largest dihedral angle.  1 is best, negative is inverted."""
    c = dihedral_cosines(x)
    small = np.sqrt(np.maximum(1.0 - c.max(-1)**2, 0.0)) / 0.9428
    large = np.sqrt(np.maximum(1.0 - c.min(-1)**2, 0.0)) / 0.9428
    q = radius_ratio(x)
    return np.where(q > 0, np.minimum(q, np.minimum(small, large)), q - 1e-3)


# -------------------------------------------------------- lattice and cutting


def stuff(centre, scale):
    """Mesh {shape < 0} with a BCC lattice seen through an inversion.
    Returns nodes and tetrahedra (positively oriented)."""
    def to_x(u):
        v = u - centre
        return centre + v * (scale**2 / np.maximum((v * v).sum(-1, keepdims=True), 1e-9))

    # bounding box of the body in mapped space (an inversion is its own inverse)
    g = np.stack(np.meshgrid(*[np.arange(-115, 116, 3.0)] * 3, indexing='ij'), -1).reshape(-1, 3)
    g = to_x(g[shape(g) < 6.0])
    a = H_LATTICE
    lo = np.floor(g.min(0) / a).astype(int) - 2
    n = np.ceil(g.max(0) / a).astype(int) + 3 - lo
    # two interleaved cubic lattices: corners, then cell centres
    idx = np.stack(np.meshgrid(*[np.arange(k) for k in n], indexing='ij'), -1).reshape(-1, 3)
    u = np.concatenate([(idx + lo) * a, (idx + lo + 0.5) * a])

    def corner(i): return np.ravel_multi_index(i.T, n)
    def middle(i): return corner(i) + len(idx)
    tets = []
    inner = idx[(idx > 0).all(1) & (idx < n - 1).all(1)]
    for ax in range(3):     # around each centre-to-centre edge: four tetrahedra
        e, f, h = np.eye(3, dtype=int)[[ax, (ax + 1) % 3, (ax + 2) % 3]]
        ring = [inner + e, inner + e + f, inner + e + f + h, inner + e + h]
        for k in range(4):
            tets.append(np.stack([middle(inner), middle(inner + e),
                                  corner(ring[k]), corner(ring[(k + 1) % 4])], 1))
    tets = np.concatenate(tets)
    x = to_x(u)
    phi = shape(x)
    tets = tets[(phi[tets] < 0).any(1)]
    assert ((u[tets] - centre)**2).sum(-1).min() > (2 * a)**2

    # edges that cross the surface, and where
    pairs = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
    edges = np.unique(np.sort(tets[:, pairs].reshape(-1, 2), 1), axis=0)
    edges = edges[phi[edges[:, 0]] * phi[edges[:, 1]] < 0]
    p, q = x[edges[:, 0]], x[edges[:, 1]]
    lo, hi = np.zeros(len(p)), np.ones(len(p))
    sign = np.sign(phi[edges[:, 0]])
    for _ in range(45):
        mid = 0.5 * (lo + hi)
        same = shape(p + mid[:, None] * (q - p)) * sign > 0
        lo, hi = np.where(same, mid, lo), np.where(same, hi, mid)
    t = 0.5 * (lo + hi)
    cut = p + t[:, None] * (q - p)

    # snap lattice nodes that are close to one of their cuts
    both = edges < len(idx)
    alpha = np.where(both[:, 0] == both[:, 1], SNAP[0], SNAP[1])
    best = {}
    for k in range(len(edges)):
        for end, frac in ((0, t[k]), (1, 1.0 - t[k])):
            if frac < alpha[k]:
                v = edges[k, end]
                if v not in best or frac / alpha[k] < best[v][0]:
                    best[v] = (frac / alpha[k], k)
    for v, (_, k) in best.items():
        x[v], phi[v] = cut[k], 0.0
    side = np.where(phi < 0, 1, np.where(phi > 0, -1, 0))   # +1 inside
    cut_id = {}
    new = []
    for k, (i, j) in enumerate(edges):
        if side[i] * side[j] < 0:
            cut_id[i, j] = cut_id[j, i] = len(x) + len(new)
            new.append(cut[k])
    x = np.concatenate([x, np.array(new).reshape(-1, 3)])

    # clip every tetrahedron.  Quadrilaterals are split by the diagonal from
    # their deepest inside node: a total order, so neighbours always agree.
    out = []

    def pyramid(q0, q1, q2, q3, apex):      # quad split by q0-q2
        out.extend([(q0, q1, q2, apex), (q0, q2, q3, apex)])

    for tet in tets:
        pos = sorted((v for v in tet if side[v] > 0), key=lambda v: (phi[v], v))
        zero = [v for v in tet if side[v] == 0]
        neg = [v for v in tet if side[v] < 0]
        c = cut_id
        if not pos:
            if not neg and shape(x[tet].mean(0)) < 0:
                out.append(tuple(tet))
        elif not neg:
            out.append(tuple(tet))
        elif len(pos) == 1:
            out.append((pos[0], *zero, *(c[pos[0], m] for m in neg)))
        elif len(pos) == 2 and len(neg) == 1:
            (a0, b0), m = pos, neg[0]
            pyramid(a0, b0, c[b0, m], c[a0, m], zero[0])
        elif len(pos) == 3:
            a0, b0, d0 = pos
            m = neg[0]
            out.append((a0, c[a0, m], c[b0, m], c[d0, m]))
            pyramid(b0, d0, c[d0, m], c[b0, m], a0)
        else:
            (a0, b0), (m, o) = pos, neg
            out.append((a0, b0, c[b0, m], c[b0, o]))
            pyramid(c[a0, m], c[b0, m], c[b0, o], c[a0, o], a0)
    tets = np.array(out)
    used = np.unique(tets)
    back = np.full(len(x), -1)
    back[used] = np.arange(len(used))
    x, tets = x[used], back[tets]
    flip = det6(x[tets]) < 0
    tets[flip] = tets[flip][:, [1, 0, 2, 3]]
    return x, tets


def boundary(tets):
    """Outward boundary triangles."""
    f = tets[:, FACES].reshape(-1, 3)
    _, first, count = np.unique(np.sort(f, 1), axis=0, return_index=True, return_counts=True)
    assert count.max() <= 2
    return f[np.sort(first[count == 1])]


# --------------------------------------------------------------- optimisation


def directions(n, turn):
    """n well spread unit vectors, a different set for each turn."""
    i = np.arange(n) + 0.5
    z = 1 - 2 * i / n
    a = np.pi * (1 + 5**0.5) * i + turn
    d = np.stack([np.sqrt(1 - z * z) * np.cos(a), np.sqrt(1 - z * z) * np.sin(a), z], 1)
    return d @ rotation('x', 77.0 * turn) @ rotation('y', 41.0 * turn)


def triangle_quality(x):
    """4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle."""
    a, b, c = x[..., 0, :], x[..., 1, :], x[..., 2, :]
    n = np.cross(b - a, c - a)
    return 2 * 3**0.5 * np.sqrt((n * n).sum(-1)) / (
        ((b - a)**2).sum(-1) + ((c - b)**2).sum(-1) + ((a - c)**2).sum(-1))


def penalty(tets, tris):
    """Low is good; a single bad element dominates the sum."""
    s = score(tets)
    cost = np.where(s > 0, np.maximum(s, 1e-3)**-4.0, 1e12 * (1 - s)).sum(-1)
    if tris is not None:
        cost = cost + (np.maximum(triangle_quality(tris), 1e-2)**-4.0).sum(-1)
        # stay close to the surface in the middle of the triangle as well
        edge2 = ((tris[..., 1, :] - tris[..., 0, :])**2).sum(-1)
        cost = cost + 400.0 * (shape(tris.mean(-2))**2 / edge2).sum(-1)
    return cost


def improve(x, tets, passes=24):
    x = x.copy()
    tris = boundary(tets)
    tets_of = [[] for _ in x]
    tris_of = [[] for _ in x]
    for k, t in enumerate(tets):
        for v in t:
            tets_of[v].append(k)
    for k, t in enumerate(tris):
        for v in t:
            tris_of[v].append(k)
    for turn in range(passes):
        worst = score(x[tets])
        order = np.argsort([worst[k].min() for k in tets_of], kind='stable')
        reach = 0.30 * 0.93**turn
        dirs = directions(10, turn)
        moves = np.concatenate([np.zeros((1, 3)), dirs, 0.35 * dirs, 0.1 * dirs])
        for v in order:
            star, fan = tets[tets_of[v]], tris[tris_of[v]]
            mean = x[star].reshape(-1, 3).mean(0)       # Laplacian-like target
            size = np.sqrt(((x[star] - x[v])**2).sum(-1)).max(-1).mean()
            cand = x[v] + reach * size * moves
            cand = np.concatenate([cand, [0.5 * (x[v] + mean), mean]])
            if len(fan):
                cand = project(cand, 2)
            xt = np.broadcast_to(x[star], (len(cand),) + star.shape + (3,)).copy()
            xt[:, star == v] = cand[:, None]
            xs = None
            if len(fan):
                xs = np.broadcast_to(x[fan], (len(cand),) + fan.shape + (3,)).copy()
                xs[:, fan == v] = cand[:, None]
            cost = penalty(xt, xs)
            k = int(np.argmin(cost))
            if cost[k] < cost[0] * (1 - 1e-6):
                x[v] = cand[k]
    return x


# --------------------------------------------------------------------- output


def build():
    d = PATCH_DIR / np.linalg.norm(PATCH_DIR)
    patch = on_ray(PATCH_FROM, d)
    n = gradient(patch)
    n /= np.linalg.norm(n)
    up = (n + TILT) / np.sqrt(((n + TILT)**2).sum())
    x, tets = stuff(patch + GRADING * up, GRADING)
    x = improve(x, tets)

    order = np.argsort(x[:, 0], kind='stable')          # right to left: a narrow band
    back = np.empty(len(x), int)
    back[order] = np.arange(len(x))
    x, tets = x[order], back[tets]
    tets = tets[np.argsort(tets.min(1), kind='stable')]

    tris = boundary(tets)
    near = np.sqrt(((x - patch)**2).sum(1)) < PATCH_RADIUS
    held = np.sqrt(((x - LIGAMENT_AT)**2).sum(1)) < LIGAMENT_RADIUS
    lesion = np.sqrt(((x[tets].mean(1) - (patch - LESION_DEPTH * n))**2).sum(1)) < LESION_RADIUS
    volumes = {'parenchyma': tets[~lesion], 'lesion': tets[lesion]}
    surfaces = {'surface': tris,
                'ligament': tris[held[tris].all(1)],
                'front': tris[near[tris].all(1)]}
    assert not set(surfaces['ligament'].ravel()) & set(surfaces['front'].ravel())
    return 1e-3 * x, volumes, surfaces


def write(path, x, volumes, surfaces):
    """MSH 2.2 ASCII.  This format has one physical group per element, so the
    triangles of overlapping groups are written once for each group."""
    groups = [(2, 1 + i, name, e) for i, (name, e) in enumerate(surfaces.items())]
    groups += [(3, 11 + i, name, e) for i, (name, e) in enumerate(volumes.items())]
    with open(path, 'w', newline='\n') as f:
        f.write('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n' % len(groups))
        for dim, tag, name, _ in groups:
            f.write('%d %d "%s"\n' % (dim, tag, name))
        f.write('$EndPhysicalNames\n$Nodes\n%d\n' % len(x))
        for i, p in enumerate(x):
            f.write('%d %.7f %.7f %.7f\n' % (i + 1, *p))
        f.write('$EndNodes\n$Elements\n%d\n' % sum(len(g[3]) for g in groups))
        k = 0
        for dim, tag, _, elements in groups:
            for e in elements:
                k += 1
                f.write('%d %d 2 %d %d %s\n' % (k, 2 if dim == 2 else 4, tag, tag,
                                               ' '.join(str(v + 1) for v in e)))
        f.write('$EndElements\n')


def main():
    x, volumes, surfaces = build()
    x = np.round(x, 7)          # judge what is written, not what was computed
    tets = np.concatenate(list(volumes.values()))
    angle = np.degrees(np.arccos(dihedral_cosines(x[tets])))
    q = radius_ratio(x[tets])
    print('%d nodes, %d tetrahedra, volume %.4g m3' % (len(x), len(tets), det6(x[tets]).sum() / 6))
    print('box', x.min(0), x.max(0))
    print('radius ratio: min %.3f, mean %.3f' % (q.min(), q.mean()))
    print('dihedral angles: %.1f to %.1f degrees' % (angle.min(), angle.max()))
    for name, e in {**volumes, **surfaces}.items():
        print('%-10s %5d elements, %4d nodes' % (name, len(e), len(np.unique(e))))
    if det6(x[tets]).min() <= 0 or angle.min() < 10:
        sys.exit('mesh quality below the bar, nothing written')
    here = os.path.dirname(os.path.abspath(__file__))
    path = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, 'organ.msh')
    write(path, x, volumes, surfaces)


if __name__ == '__main__':
    main()
