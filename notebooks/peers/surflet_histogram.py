"""Wahl's histogram of all pairs of N oriented points in sequential Python, as a reader would write it first:
surflet_histogram.py N. Prints the pairs, the seconds and the histogram's checksum as JSON."""
import json
import math
import random
import sys
import time

BINS = 5


def torus_points(n):
    """Points and unit normals on a torus of radii 1 and 0.4."""
    rng = random.Random(1)
    points = []
    for _ in range(n):
        u, v = (rng.uniform(0, 2 * math.pi) for _ in range(2))
        normal = (math.cos(u) * math.cos(v), math.sin(u) * math.cos(v), math.sin(v))
        points.append(((math.cos(u) + 0.4 * normal[0], math.sin(u) + 0.4 * normal[1], 0.4 * normal[2]), normal))
    return points


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def features(first, second, max_distance):
    """alpha, beta, gamma, delta of a pair (thesis 3.3.1), each scaled to [0, 1]."""
    (p, n), (q, m) = first, second
    d = (q[0] - p[0], q[1] - p[1], q[2] - p[2])
    length = math.sqrt(dot(d, d))
    d = (d[0] / length, d[1] / length, d[2] / length)
    if abs(dot(n, d)) > abs(dot(m, d)):
        n, m, d = m, n, (-d[0], -d[1], -d[2])
    v = cross(d, n)
    size = math.sqrt(dot(v, v)) or 1.0
    v = (v[0] / size, v[1] / size, v[2] / size)
    w = cross(n, v)
    alpha = math.atan2(dot(w, m), dot(n, m))
    return (0.5 + alpha / (2 * math.pi), 0.5 + dot(v, m) / 2, 0.5 + dot(n, d) / 2, length / max_distance)


def histogram(points):
    max_distance = max(math.dist(a[0], b[0]) for i, a in enumerate(points) for b in points[:i])
    counts = [0] * BINS**4
    for i, first in enumerate(points):
        for second in points[:i]:
            bin_number = 0
            for value in features(first, second, max_distance):
                bin_number = bin_number * BINS + min(int(value * BINS), BINS - 1)
            counts[bin_number] += 1
    return counts


points = torus_points(int(sys.argv[1]))
start = time.process_time()
counts = histogram(points)
seconds = time.process_time() - start
print(json.dumps({"pairs": sum(counts), "seconds": seconds, "occupied_bins": sum(c > 0 for c in counts)}))
