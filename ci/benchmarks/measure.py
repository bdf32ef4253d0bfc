"""What the benchmarks share: running the program, taking the least of interleaved repetitions, tables.

Ratios come from one run of a benchmark, whose arms take turns, so that whatever else the machine
does hits all of them. Times are the least of the repetitions: noise only ever adds.
"""
import json
import os
import subprocess
import sys
import time

PROGRAM = os.environ["DIPTYCH"]
BUILD = os.environ["DIPTYCH_BUILD"]
OUT = os.environ["DIPTYCH_OUT"]
SCENES = os.path.join(os.environ["DIPTYCH_SHARED"], "scenes")


class Run:
    """One run of a process: seconds of wall clock and of processor, peak bytes, what it said."""

    def __init__(self, command, environment=None):
        stdout, stderr = (os.path.join(OUT, name) for name in ("stdout", "stderr"))
        with open(stdout, "wb") as out, open(stderr, "wb") as err:
            start = time.perf_counter()
            process = subprocess.Popen(
                command, stdout=out, stderr=err, env={**os.environ, **(environment or {})}
            )
            _, status, usage = os.wait4(process.pid, 0)
            self.wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        self.cpu = usage.ru_utime + usage.ru_stime
        self.peak_bytes = usage.ru_maxrss * 1024
        with open(stdout, encoding="utf-8") as text:
            self.stdout = text.read()
        with open(stderr, encoding="utf-8") as text:
            self.stderr = text.read()
        if process.returncode != 0:
            sys.exit(f"{' '.join(command)}: {self.stderr.strip() or process.returncode}")


class Render(Run):
    """`diptych render` of a scene; `report` is what --json says. No picture is kept."""

    def __init__(self, scene, *arguments, environment=None):
        command = [PROGRAM, "render", scene, *map(str, arguments), "--json", "-"]
        if "--pixel" not in arguments:
            command += ["-o", os.path.join(OUT, "picture.exr")]
        super().__init__(command, environment)
        self.report = json.loads(self.stdout[self.stdout.index("{") :])

    @property
    def seconds(self):
        return self.report["render"]

    @property
    def samples_per_second(self):
        return self.report["paths"] / self.report["render"]


def scene(name):
    """The glTF file of a scene of DIPTYCH_SHARED; without it the benchmark ends, saying so."""
    folder = os.path.join(SCENES, name)
    files = os.listdir(folder) if os.path.isdir(folder) else []
    found = sorted(file for file in files if file.endswith((".glb", ".gltf")))
    if not found:
        print(f"not measured: no scene in {folder}; set DIPTYCH_SHARED to the folder with scenes/")
        sys.exit(0)
    return os.path.join(folder, found[0])


def interleave(arms, repetitions):
    """arms: name -> function that makes a run. The runs of each arm, which take turns."""
    runs = {name: [] for name in arms}
    for _ in range(repetitions):
        for name, run in arms.items():
            runs[name].append(run())
    return runs


def least(runs, key):
    return min(key(run) for run in runs)


def table(heads, rows):
    """Prints rows of cells, the first column to the left and the others to the right."""
    cells = [heads, *rows]
    widths = [max(len(str(row[k])) for row in cells) for k in range(len(heads))]
    for row in cells:
        first, *others = (str(cell) for cell in row)
        line = first.ljust(widths[0])
        for cell, width in zip(others, widths[1:]):
            line += "  " + cell.rjust(width)
        print("  " + line.rstrip(), flush=True)
