#!/usr/bin/env python3
"""Uses the labelling server as pages do, for a long time, and says what grows.

    bench/soak_label_server.py PROGRAM MAP [--labels 10000] [--minutes 30] [--pages 4] [--hours 8]

Works on a copy of MAP, which needs an overhead image. First draws labels until the map has
--labels of them. Then --pages pages work at the same time: each looks at tiles and lists, draws,
changes and deletes labels (as many as it draws), and keeps a stream of events open. Every tenth of the time the
script measures the server's memory, its open files, the size of the map file and the answer times.
It fits a line through the measurements and prints what --hours of the same work would add.

Exit status 1: an answer was wrong, a label that the server confirmed is missing at the end, or the
median answer of the last tenth takes more than twice as long as that of the second tenth.
Uses Python's standard library alone.
"""

import argparse
import http.client
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time


class Page:
    """One browser page: a connection with the token, and what it has drawn."""

    def __init__(self, port, token, who, seed):
        self.port, self.token, self.who = port, token, who
        self.random = random.Random(seed)
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
        self.own = {}  # id: version
        self.times = []  # (moment, seconds, what)
        self.faults = []

    def ask(self, method, path, body=None, want=(200,)):
        head = {"Authorization": f"Bearer {self.token}"}
        if body is not None:
            body = json.dumps(body)
            head |= {"Origin": f"http://127.0.0.1:{self.port}", "Content-Type": "application/json"}
        start = time.monotonic()
        try:
            self.connection.request(method, path, body, head)
            answer = self.connection.getresponse()
            data = answer.read()
        except (OSError, http.client.HTTPException):  # the server may close an idle connection
            self.connection.close()
            self.connection.request(method, path, body, head)
            answer = self.connection.getresponse()
            data = answer.read()
        what = method + " " + re.sub(r"\d+", "N", path)
        self.times.append((start, time.monotonic() - start, what))
        if answer.status not in want:
            self.faults.append(f"{what}: got {answer.status} {data[:200]!r}, want {want}")
            return None
        return json.loads(data) if "json" in answer.getheader("Content-Type", "") else data

    def box(self, bounds):
        (low_x, low_y), (high_x, high_y) = bounds
        return {"kind": "parking_space", "source": "drawn", "shape": "box",
                "x": self.random.uniform(low_x, high_x), "y": self.random.uniform(low_y, high_y),
                "heading": self.random.uniform(-3.1, 3.1), "length": 5.0, "width": 2.4,
                "who": self.who}

    def draw(self, bounds, count=1):
        labels = [self.box(bounds) for _ in range(count)]
        for label in labels if count == 1 else [{"labels": labels, "who": self.who}]:
            stored = self.ask("POST", "/api/labels", label)
            if stored:
                for one in stored.get("labels", [stored]):
                    self.own[one["id"]] = one["version"]

    def step(self, bounds, tiles):
        choice = self.random.random()
        if choice < 0.35:
            self.ask("GET", self.random.choice(tiles), want=(200, 404))
        elif choice < 0.45:
            self.ask("GET", "/api/history")
        elif choice < 0.5:
            self.ask("GET", "/api/labels")
        elif choice < 0.68 or not self.own:
            self.draw(bounds)
        elif choice < 0.82:
            label = self.random.choice(list(self.own))
            stored = self.ask("PUT", f"/api/labels/{label}",
                              {"version": self.own[label], "who": self.who,
                               "note": f"{self.random.random()}"})
            if stored:
                self.own[label] = stored["version"]
        else:
            label = self.random.choice(list(self.own))
            if self.ask("DELETE", f"/api/labels/{label}",
                        {"version": self.own[label], "who": self.who}):
                del self.own[label]


def memory_mb(pid):
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024.0
    return float("nan")


def slope(points):
    """Of the line of least squares through (x, y)."""
    n = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    below = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / below if below else 0.0


def median(values):
    return sorted(values)[len(values) // 2] if values else float("nan")


def listen(port, token, stop):
    """Reads the stream of events, as a page does."""
    while not stop.is_set():
        try:
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=2)
            connection.request("GET", "/api/events", headers={"Authorization": f"Bearer {token}"})
            answer = connection.getresponse()
            while not stop.is_set() and answer.read1(65536):
                pass
        except OSError:
            pass


def soak(server, port, token, map_file, options):
    pages = [Page(port, token, f"user {i}", i) for i in range(options.pages)]
    start = pages[0].ask("GET", "/api/start")
    poses = [pose for session in start["poses"] for pose in session]
    xs, ys = [pose[0] for pose in poses], [pose[1] for pose in poses]
    bounds = ((min(xs), min(ys)), (max(xs), max(ys)))
    tiles = [f"/tiles/{z}/{x}/{y}.png" for z in range(5) for x in range(4) for y in range(4)]
    missing = options.labels - len(pages[0].ask("GET", "/api/labels")["labels"])
    begun = time.monotonic()
    while missing > 0:
        pages[missing % options.pages].draw(bounds, min(500, missing))
        missing -= 500
    print(f"{options.labels} labels after {time.monotonic() - begun:.0f} s, "
          f"{memory_mb(server.pid):.0f} MB", flush=True)
    stop = threading.Event()

    def work(page):
        while not stop.is_set() and len(page.faults) < 10:
            page.step(bounds, tiles)
            time.sleep(options.pause)

    threads = [threading.Thread(target=work, args=(page,)) for page in pages]
    threads += [threading.Thread(target=listen, args=(port, token, stop)) for _ in pages]
    for page in pages:
        page.times.clear()
    begun = time.monotonic()
    for thread in threads:
        thread.start()
    rows = []
    for part in range(10):
        time.sleep(6.0 * options.minutes)
        now = time.monotonic()
        # Answers without lists: lists grow with the labels, as they must.
        times = [s for page in pages for t, s, what in list(page.times)
                 if now - 6.0 * options.minutes <= t and what != "GET /api/labels"]
        rows.append(((now - begun) / 3600.0, memory_mb(server.pid),
                     map_file.stat().st_size / 1e6, len(os.listdir(f"/proc/{server.pid}/fd")),
                     median(times), sorted(times)[int(0.99 * len(times))] if times else 0.0,
                     len(times)))
        print("{:5.2f} h  {:7.1f} MB memory  {:7.1f} MB file  {:3} open files  median {:.4f} s  "
              "99 % {:.4f} s  {} answers".format(*rows[-1]), flush=True)
    stop.set()
    for thread in threads:
        thread.join()
    return pages, rows


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("map")
    parser.add_argument("--labels", type=int, default=10000)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--pages", type=int, default=4)
    parser.add_argument("--hours", type=float, default=8.0)
    parser.add_argument("--pause", type=float, default=0.2, help="of a page between requests [s]")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        map_file = pathlib.Path(folder) / "soak.gpkg"
        shutil.copy(options.map, map_file)
        server = subprocess.Popen([options.program, "label", "-m", str(map_file), "--port", "0"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        try:
            address = ""
            while "token=" not in address:
                address = server.stdout.readline()
                if not address:
                    sys.exit("error: the server printed no address")
            port, token = re.search(r":(\d+)/\?token=(\S+)", address).groups()
            pages, rows = soak(server, int(port), token, map_file, options)
            there = {label["id"] for label in pages[0].ask("GET", "/api/labels")["labels"]}
        finally:
            server.terminate()
            server.wait(300)
    lost = [label for page in pages for label in page.own if label not in there]
    faults = [fault for page in pages for fault in page.faults]
    later = rows[1:]  # caches fill in the first tenth
    hours = options.hours
    print(f"{hours:g} h of this work add {hours * slope([(r[0], r[1]) for r in later]):.0f} MB of "
          f"memory and {hours * slope([(r[0], r[2]) for r in later]):.0f} MB of file")
    print(f"{len(faults)} wrong answers, {len(lost)} confirmed labels missing")
    for fault in faults[:5]:
        print("  " + fault)
    slow = rows[-1][4] > 2.0 * rows[1][4]
    if slow:
        print(f"answers became slower: {rows[1][4]:.4f} s to {rows[-1][4]:.4f} s")
    sys.exit(1 if faults or lost or slow else 0)


if __name__ == "__main__":
    main()
