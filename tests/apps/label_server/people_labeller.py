#!/usr/bin/env python3
"""Plays a labeller who knows where everybody is, through the labelling page's requests.

people_labeller.py ROADBOOK PRINT_PEOPLE MAP SESSION DRIVE

Session number SESSION of MAP is the simulated DRIVE. Images are taken as the server brings them;
boxes drawn and rounds are those of `roadbook detect --oracle`. What was taught is in MAP then:
`roadbook detect -m MAP` uses it.
"""
import http.client
import json
import math
import re
import subprocess
import sys
import time

BREADTH = 0.41  # of a person's box over its height


def overlap(a, b):
    """Intersection over union of two windows (azimuth, foot slope, size)."""
    def common(a0, a1, b0, b1):
        return max(0.0, min(a1, b1) - max(a0, b0))

    apart = (b[0] - a[0] + math.pi) % (2 * math.pi) - math.pi
    ha, hb = 0.5 * BREADTH * a[2], 0.5 * BREADTH * b[2]
    both = common(-ha, ha, apart - hb, apart + hb) * common(a[1], a[1] + a[2], b[1], b[1] + b[2])
    return both / (2 * (ha * a[2] + hb * b[2]) - both)


class Page:
    """What a browser's page does."""

    def __init__(self, address):
        self.host, self.token = re.match(r"http://([^/]+)/\?token=(\w+)", address).groups()

    def ask(self, method, path, body=None):
        connection = http.client.HTTPConnection(self.host)
        fields = {"Authorization": "Bearer " + self.token, "Origin": "http://" + self.host,
                  "Content-Type": "application/json"}
        connection.request(method, path, None if body is None else json.dumps(body), fields)
        answer = connection.getresponse()
        text = json.loads(answer.read())
        if answer.status >= 300:
            raise RuntimeError(f"{path}: {answer.status} {text}")
        return text

    def store(self, drafts):
        for draft in drafts:
            draft.setdefault("shape", "upright")
        return self.ask("POST", "/api/labels", {"who": "labeller", "labels": drafts})

    def learn(self):
        self.ask("POST", "/api/people/learn", {})
        while True:
            overview = self.ask("GET", "/api/people")
            if not overview["running"]:
                return overview
            time.sleep(0.1)


class Labeller:
    def __init__(self, page, truth):
        self.page, self.truth = page, truth
        self.drawn = self.clicks = self.images = self.empty = 0

    def look_at(self, name, to_draw):
        """One image, all of it; the number of people drawn."""
        image = self.page.ask("GET", f"/api/people/{name['session']}/{name['t_ns']}/{name['camera']}")
        people = self.truth.get((name["t_ns"], name["camera"]), [])
        if not people and self.empty > self.images - self.empty:
            return 0  # n: as many without anybody as with somebody are enough
        drafts, known = [], []

        def say(kind, source, box, score):
            drafts.append({**name, "kind": kind, "source": source, "score": score,
                           "azimuth": box[0], "foot_slope": box[1], "size": box[2]})

        for h in image["hypotheses"]:
            box = (h["azimuth"], h["foot_slope"], h["size"])
            hits = [(overlap(box, p[:3]), p) for p in people]
            best, person = max(hits, default=(0.0, None))
            likely = h["probability"] >= 0.5
            if best >= 0.5:
                if best < 0.8:  # put right by keys, as long as a click
                    self.clicks += 1
                    box = person[:3]
                self.clicks += 0 if likely and best >= 0.8 else 1
                say("person", "accepted", box, h["probability"])
                known.append(person)
            elif best < 0.2:
                self.clicks += 1 if likely else 0  # what is unlikely goes with Enter
                say("not_person", "detected", box, h["probability"])
            else:
                self.clicks += 1  # skipped
        drew = 0
        for person in people:
            if person in known or not person[3] or drew == to_draw:
                continue
            say("person", "drawn", person[:3], 1.0)
            drew += 1
        # Who is hidden or was not drawn must not be called nobody: then the image is not done.
        if all(p in known for p in people) or drew == len(people) - len(known):
            drafts.append({**name, "kind": "not_person", "source": "drawn", "score": 1.0,
                           "shape": "image"})
            self.clicks += 1
        self.images += 1
        self.empty += 0 if people else 1
        if drafts:
            self.page.store(drafts)
        self.drawn += drew
        return drew


def main(roadbook, print_people, map_file, session, drive):
    truth = {}
    listed = subprocess.run([print_people, map_file, session, drive], capture_output=True, text=True,
                            check=True)
    for line in listed.stdout.splitlines():
        t_ns, camera, azimuth, slope, size, clear = line.split()
        truth.setdefault((t_ns, int(camera)), []).append(
            (float(azimuth), float(slope), float(size), clear == "1"))
    server = subprocess.Popen([roadbook, "label", "-m", map_file, "--drive", drive, "--port", "0"],
                              stdout=subprocess.PIPE, text=True)
    try:
        address = next(re.search(r"http:\S+", line).group() for line in server.stdout if "http:" in line)
        page = Page(address)
        labeller = Labeller(page, truth)
        overview = page.ask("GET", "/api/people")
        for number in range(7):
            to_draw = 8 if number == 0 else 4
            for name in overview["queue"]:
                to_draw -= labeller.look_at(name, to_draw)
            overview = page.learn()
            last = overview["rounds"][-1]
            print(f"round {last['round']}: from {last['persons']} people and {last['nobody']} windows "
                  f"without ({last['seconds']:.1f} s); so far {labeller.drawn} drawn, "
                  f"{labeller.clicks} clicks, {labeller.images} images", flush=True)
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
