"""read_label_files.py FORMAT FILE [LATITUDE LONGITUDE]: labels as another program would read them, with
nothing of roadbook: a line a label, class, then x y of each corner in metres of the map."""
import json
import math
import os
import re
import struct
import sys


def png_size(path):
    with open(path, "rb") as file:
        head = file.read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", "no PNG"
    return struct.unpack(">II", head[16:24])


def world(path):
    a, d, b, e, c, f = (float(line) for line in open(path))
    assert b == d == 0
    # A world file tells the middle of the first pixel; pixels here count from its edge.
    return lambda u, v: (c + a * (u - 0.5), f + e * (v - 0.5))


def coco(path):
    data = json.load(open(path))
    (image,) = data["images"]
    picture = os.path.join(os.path.dirname(path), image["file_name"])
    assert png_size(picture) == (image["width"], image["height"])
    place = world(os.path.splitext(picture)[0] + ".pgw")
    names = {c["id"]: c["name"] for c in data["categories"]}
    for a in data["annotations"]:
        (ring,) = a["segmentation"]
        pixels = list(zip(ring[::2], ring[1::2]))
        x, y, w, h = a["bbox"]
        assert abs(min(u for u, _ in pixels) - x) < 1e-9 and abs(max(v for _, v in pixels) - y - h) < 1e-9
        assert a["iscrowd"] == 0 and a["image_id"] == image["id"] and a["area"] > 0
        yield names[a["category_id"]], [place(u, v) for u, v in pixels]


def yolo(path):
    text = open(os.path.join(path, "data.yaml")).read()
    names = [json.loads(n) for n in re.findall(r"^  - (.*)$", text.split("names:")[1], re.M)]
    width, height = png_size(os.path.join(path, "images/overhead.png"))
    place = world(os.path.join(path, "images/overhead.pgw"))
    for line in open(os.path.join(path, "labels/overhead.txt")):
        kind, *shares = line.split()
        shares = [float(s) for s in shares]
        assert all(0 <= s <= 1 for s in shares)
        yield names[int(kind)], [place(u * width, v * height) for u, v in zip(shares[::2], shares[1::2])]


def geojson(path, latitude, longitude):
    phi = math.radians(latitude)
    e2 = 0.00669437999014
    n = 6378137 / math.sqrt(1 - e2 * math.sin(phi) ** 2)
    m = n * (1 - e2) / (1 - e2 * math.sin(phi) ** 2)
    for feature in json.load(open(path))["features"]:
        if feature["properties"]["layer"] not in ("parking_spaces", "crossings", "other_labels"):
            continue
        (ring,) = feature["geometry"]["coordinates"]
        assert ring[0] == ring[-1]
        yield feature["properties"]["class"], [
            (math.radians(lon - longitude) * n * math.cos(phi), math.radians(lat - latitude) * m)
            for lon, lat, _ in ring[:-1]]


reader = {"coco": coco, "yolo": yolo, "geojson": geojson}[sys.argv[1]]
for kind, corners in reader(sys.argv[2], *map(float, sys.argv[3:])):
    print(kind, *(f"{value:.6f}" for corner in corners for value in corner))
