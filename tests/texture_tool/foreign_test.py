#!/usr/bin/env python3
"""TX-10 to TX-12 and the defined results: a texture gives the same bits in three foreign programs.

Usage: foreign_test.py EXPECTED_LINES PROGRAM... -- OPENCL_PROGRAM KERNEL
"""
import subprocess
import sys


def lines(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 77:
        return None
    if done.returncode:
        sys.exit(f"{command}: exit code {done.returncode}\n{done.stderr}")
    # Only the sign of a NaN may differ.
    return [line.replace("-nan", "nan") for line in done.stdout.splitlines()]


split = sys.argv.index("--")
commands = [[program] for program in sys.argv[1:split]]
if len(sys.argv) > split + 1:
    commands.append(sys.argv[split + 1:])
expected = lines(commands[0])
wrong = 0
for command in commands[1:]:
    found = lines(command)
    if found is None:
        print("no OpenCL device here, not compared")
        continue
    for k, (a, b) in enumerate(zip(expected, found)):
        if a != b and wrong < 5:
            print(f"{command[0]}: hit {k}: {b}, not {a}")
        wrong += a != b
if len(expected) != 64 or len(set(expected)) < 2:
    sys.exit(f"the texture gives nothing to compare: {expected[:2]}")
sys.exit(1 if wrong else 0)
