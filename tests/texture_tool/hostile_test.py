#!/usr/bin/env python3
"""Every texture of tests/hostile/textures is refused with the message in its first line.

Usage: hostile_test.py TOOL FOLDER

The first line reads `// expect: LINE:COLUMN: text`. Words that are Clang's own differ from version
to version: with another LLVM than 14 only our own messages are compared whole.
"""
import concurrent.futures
import os
import re
import subprocess
import sys

TOOL, FOLDER = sys.argv[1:3]
OWN = re.compile(r"; (?!correct it|convert it|declare it|add it|components|make both|give every)")


def check(path, whole):
    """What is wrong with how the tool treats a file, or None."""
    with open(path, encoding="utf-8", errors="replace") as file:
        expected = file.readline().removeprefix("// expect: ").rstrip("\n")
    name = os.path.basename(path)
    # The tool gives itself 10 s of the processor, which a crowded machine may stretch to minutes.
    done = subprocess.run([TOOL, path, "--name", name, "--opencl", "-"], capture_output=True, timeout=600)
    errors = [line for line in done.stderr.decode("utf-8", "replace").split("\n") if ": error: " in line]
    if done.returncode != 2 or done.stdout:
        return f"{name}: exit code {done.returncode}; it must be refused: {expected}"
    found = errors[0].removeprefix(name + ":").replace(" error: ", " ", 1) if errors else "no message"
    if found == expected:
        return None
    if not whole and not OWN.search(expected) and found.split(":")[0] == expected.split(":")[0]:
        return None
    return f"{name}:\n  expected {expected}\n  found    {found}"


def main():
    version = subprocess.run([TOOL, "--version"], capture_output=True, text=True).stdout
    paths = sorted(os.path.join(FOLDER, name) for name in os.listdir(FOLDER) if name.endswith(".c"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [text for text in pool.map(lambda path: check(path, " 14." in version), paths) if text]
    for text in wrong:
        print(text)
    print(f"{len(paths)} hostile textures, {len(wrong)} treated otherwise than expected")
    sys.exit(1 if wrong or len(paths) < 150 else 0)


main()
