"""The copy of the sources that holds the faults: its build and its ctest entries."""

import io
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import tarfile
import time

import mutants

HERE = pathlib.Path(__file__).resolve().parent


class Copy:
    """The clone that holds the faults, and its build."""

    def __init__(self, folder, jobs):
        self.folder = pathlib.Path(folder).resolve()
        self.build = self.folder / "build" / "release"
        self.jobs = str(jobs)
        if not self.folder.exists():
            subprocess.run(["git", "clone", "-q", "--local", HERE.parent.parent, self.folder], check=True)
        if not (self.build / "build.ninja").exists():
            subprocess.run(["cmake", "--preset", "release"], cwd=self.folder, check=True,
                           stdout=subprocess.DEVNULL)

    def git(self, *words):
        return subprocess.run(["git", *words], cwd=self.folder, capture_output=True, check=True).stdout

    def sources(self):
        """Path and text of each source, as committed."""
        with tarfile.open(fileobj=io.BytesIO(self.git("archive", "HEAD", *mutants.MODULES))) as tar:
            return {m.name: tar.extractfile(m).read().decode() for m in tar.getmembers()
                    if m.name.endswith(".cpp")}

    def copy_tests(self):
        for path in sorted(p for p in HERE.parent.rglob("*") if p.is_file()):
            place = self.folder / "tests" / path.relative_to(HERE.parent)
            if not place.exists() or place.read_bytes() != path.read_bytes():
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, place)
                shutil.copymode(path, place)

    def make(self, targets):
        """(whether all was built, what the compiler said)"""
        command = ["cmake", "--build", str(self.build), "-j", self.jobs]
        command += ["--target", *targets] * bool(targets) + ["--", "-k", "0"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        return done.returncode == 0, done.stdout + done.stderr

    def entries(self, programs, without):
        """The ctest entries by name: command and properties."""
        shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.build, capture_output=True,
                               check=True).stdout
        found = {}
        for test in json.loads(shown)["tests"]:
            command = test.get("command")
            if not command or re.match(without, test["name"]):
                continue
            if programs and pathlib.Path(command[0]).name not in programs:
                continue
            found[test["name"]] = (command, {p["name"]: p["value"] for p in test["properties"]})
        return found


def run_entry(entry, variables, cpu_s, wall_s):
    """(whether it passed, processor seconds)"""
    command, properties = entry
    environment = dict(os.environ, **variables)
    environment.update(v.split("=", 1) for v in properties.get("ENVIRONMENT", []))

    def limit():  # a fault may loop for ever or fill the memory
        resource.setrlimit(resource.RLIMIT_CPU, (int(cpu_s) + 1, int(cpu_s) + 1))
        resource.setrlimit(resource.RLIMIT_DATA, (8 << 30, 8 << 30))

    process = subprocess.Popen(
        command, cwd=properties.get("WORKING_DIRECTORY"), env=environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        preexec_fn=limit)
    end = time.monotonic() + wall_s
    while True:
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        if pid == 0 and time.monotonic() > end:
            os.killpg(process.pid, signal.SIGKILL)
            pid, status, used = os.wait4(process.pid, 0)
        if pid != 0:
            break
        time.sleep(0.01)
    process.returncode = os.waitstatus_to_exitcode(status)
    try:  # what it left running
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    good = process.returncode in (0, int(properties.get("SKIP_RETURN_CODE", 0)))
    return good, used.ru_utime + used.ru_stime
