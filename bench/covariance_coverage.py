#!/usr/bin/env python3
"""Share of true errors inside the 95 % regions that a map states, by image size and loops.

    covariance_coverage.py ROADBOOK FOLDER [--seeds 20] [--scales 0.25 0.5 1.0]

Renders drives of the small place `zurich`, with loops (the whole drive) and without (10 s), maps
them, and compares each keyframe with the truth. It reads the GeoPackage with sqlite3 and shares no
code with the program. Gauge: errors relative to the first keyframe of the keyframe's piece, as the
covariances are. Prints, for position (x, y), position with height, heading and all six: the share
inside in percent, and the mean squared error over its variance (1 if right).
"""

import argparse
import bisect
import csv
import math
import pathlib
import sqlite3
import struct
import subprocess

SETS = {"position": (0, 1), "xyz": (0, 1, 2), "heading": (5,), "six": (0, 1, 2, 3, 4, 5)}
CHI2_95 = {1: 3.841, 2: 5.991, 3: 7.815, 6: 12.592}


def matrix(blob, rows, columns):
    v = struct.unpack("<%dd" % (rows * columns), blob)
    return [list(v[i * columns : (i + 1) * columns]) for i in range(rows)]


def product(a, b):
    rotation = [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    shift = [sum(a[i][k] * b[k][3] for k in range(3)) + a[i][3] for i in range(3)]
    return [rotation[i] + [shift[i]] for i in range(3)]


def inverse(a):
    rotation = [[a[j][i] for j in range(3)] for i in range(3)]
    shift = [-sum(rotation[i][k] * a[k][3] for k in range(3)) for i in range(3)]
    return [rotation[i] + [shift[i]] for i in range(3)]


def perturbation(a):
    """Translation and rotation vector of a pose near the identity."""
    return [a[0][3], a[1][3], a[2][3], (a[2][1] - a[1][2]) / 2, (a[0][2] - a[2][0]) / 2,
            (a[1][0] - a[0][1]) / 2]


def squared_distance(covariance, rows, error):
    """Mahalanobis distance by Cholesky factorisation; None: not positive definite."""
    n = len(rows)
    factor = [[0.0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            s = covariance[rows[i]][rows[j]] - sum(factor[i][k] * factor[j][k] for k in range(j))
            if i == j and s <= 0.0:
                return None
            factor[i][j] = math.sqrt(s) if i == j else s / factor[j][j]
    y = []
    for i in range(n):
        y.append((error[rows[i]] - sum(factor[i][k] * y[k] for k in range(i))) / factor[i][i])
    return sum(v * v for v in y)


def true_poses(drive):
    poses = {}
    with open(drive / "state_groundtruth_estimate0" / "data.csv") as file:
        for row in csv.reader(file):
            if not row or row[0].startswith("#"):
                continue
            x, y, z, qw, qx, qy, qz = (float(v) for v in row[1:8])
            rotation = [
                [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy)],
                [2 * (qx * qy + qw * qz), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qw * qx)],
                [2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), 1 - 2 * (qx * qx + qy * qy)]]
            poses[int(row[0])] = [rotation[i] + [(x, y, z)[i]] for i in range(3)]
    return poses


def judge(map_file, drive):
    """For each set of components: keyframes, those inside, sum of squared distance by dimension."""
    truth = true_poses(drive)
    stamps = sorted(truth)
    database = sqlite3.connect("file:%s?mode=ro" % map_file, uri=True)
    frames = {i: matrix(b, 3, 4) for i, b in database.execute(
        "SELECT id, T_map_frame FROM map_frames")}
    columns = [row[1] for row in database.execute("PRAGMA table_info(keyframes)")]
    piece = "piece" if "piece" in columns else "0"
    totals = {name: [0, 0, 0.0] for name in SETS}
    unknown = 0
    first = {}
    for t_ns, frame, pose, covariance, part in database.execute(
            "SELECT t_ns, map_frame, T_frame_vehicle, covariance, %s FROM keyframes ORDER BY id"
            % piece):
        near = bisect.bisect_left(stamps, t_ns)
        if near == len(stamps) or stamps[near] != t_ns:
            continue
        estimate = product(frames[frame], matrix(pose, 3, 4))
        true = truth[t_ns]
        if part not in first:
            first[part] = (estimate, true)
            continue
        if covariance is None:
            unknown += 1
            continue
        moved = product(inverse(first[part][0]), estimate)
        error = perturbation(product(inverse(moved), product(inverse(first[part][1]), true)))
        c = matrix(covariance, 6, 6)
        for name, rows in SETS.items():
            d = squared_distance(c, rows, error)
            totals[name][0] += 1
            if d is not None:
                totals[name][1] += d <= CHI2_95[len(rows)]
                totals[name][2] += d / len(rows)
    return totals, unknown


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("roadbook")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--scales", nargs="+", default=["0.25", "0.5", "1.0"])
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print("%-22s %s  unknown" % ("drives", "  ".join("%-14s" % name for name in SETS)))
    for kind, more in (("loops", []), ("no loops", ["--max-duration-s", "10"])):
        for scale in options.scales:
            sums = {name: [0, 0, 0.0] for name in SETS}
            unknown = 0
            for seed in range(1, options.seeds + 1):
                drive = options.folder / ("%s-%s-%d" % (kind.replace(" ", "-"), scale, seed))
                map_file = drive.with_suffix(drive.suffix + ".gpkg")
                if not map_file.exists():
                    subprocess.run([options.roadbook, "simulate", "zurich", "--size", "small",
                                    "--image-scale", scale, "--seed", str(seed), "-q",
                                    "--overwrite", "-o", str(drive)] + more,
                                   check=True, stdout=subprocess.DEVNULL)
                    subprocess.run([options.roadbook, "map", str(drive), "-m", str(map_file), "-q"],
                                   check=True, stdout=subprocess.DEVNULL)
                totals, lost = judge(map_file, drive)
                unknown += lost
                for name in SETS:
                    for i in range(3):
                        sums[name][i] += totals[name][i]
            cells = ["%5.1f %% (%5.2f)" % (100.0 * s[1] / max(1, s[0]), s[2] / max(1, s[0]))
                     for s in sums.values()]
            print("%-9s scale %-6s %s  %d" % (kind, scale, "  ".join(cells), unknown), flush=True)


if __name__ == "__main__":
    main()
