"""Every loop of every shared stage runs over paths in 256- or 512-bit vectors.

Usage: vectorised_test.py STAGES_OBJECT   (kernels_cpu/stages.cpp compiled for the vector kernels)

A loop that the compiler leaves scalar still has a few wide moves, which copy structures, but no wide
arithmetic; so arithmetic, comparisons and gathers on wide registers are counted in the machine code
of each. Prints `stage: vectorised` or `stage: not vectorised ...` for each stage.
"""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# The smallest loop, scale_light, has 7 wide operations when vectorised.
LEAST = 6
# Only adds up memory, and has a loop over layers in each path's turn, which g++ leaves scalar.
SCALAR = {"accumulate_aovs"}
# Operations on one number at a time: in a loop in lanes those of constants, and of the last few paths.
SINGLE = re.compile(r"v(add|sub|mul|div|sqrt|min|max|comi|ucomi|cmp\w*)ss\b")
# Instructions that only bring values to their places.
PLACING = re.compile(r"v(mov|insert|extract|perm|unpck|punpck|shuf|pshuf|broadcast|pbroadcast|zero|align)")


def shared_stages():
    with open(os.path.join(ROOT, "common/stages/stages.h"), encoding="utf-8") as text:
        return [stage for stage in re.findall(r"X\((\w+), shared,", text.read()) if stage not in SCALAR]


def wide_operations(path):
    """(stage, variant) -> numbers of wide and of single operations in the machine code of its loop."""
    command = ["objdump", "-d", "--no-show-raw-insn", "-C", path]
    code = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    counts, current = {}, None
    for line in code.splitlines():
        if line.endswith(">:"):
            found = re.search(r"(\w+)_loop<(\d+)>", line)
            current = (found[1], int(found[2])) if found else None
            if current:
                counts[current] = [0, 0]
        elif current:
            instruction = line.split("\t")[-1]
            is_wide = re.search(r"%[yz]mm", line) and not PLACING.match(instruction)
            counts[current][0] += bool(is_wide)
            counts[current][1] += bool(SINGLE.match(instruction))
    return counts


def reason_to_skip(path):
    """Why this object cannot be judged, or None."""
    strings = subprocess.run(["objdump", "-t", path], capture_output=True, text=True).stdout
    if re.search(r"__(asan|tsan|ubsan)_", strings):
        return "built for a sanitizer, whose checks keep loops scalar"
    comment = subprocess.run(["objdump", "-s", "-j", ".comment", path], capture_output=True, text=True)
    if "clang" in comment.stdout:
        return "built by clang; the loops are shaped for g++"
    if "%ymm" not in subprocess.run(["objdump", "-d", path], capture_output=True, text=True).stdout:
        return "built for a processor without 256-bit vectors" if not has_avx2() else None
    return None


def has_avx2():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        return " avx2 " in text.read()


def main(path):
    reason = reason_to_skip(path)
    if reason:
        print(f"skipped: {reason}")
        return 77
    counts = wide_operations(path)
    failed = 0
    for stage in shared_stages():
        loops = {variant: count for (name, variant), count in counts.items() if name == stage}
        scalar = sorted(variant for variant, (wide, single) in loops.items() if wide < max(LEAST, single / 4))
        failed += not loops or bool(scalar)
        said = "vectorised" if loops and not scalar else f"not vectorised: variants {scalar} of {len(loops)}"
        wide, single = min(loops.values(), default=(0, 0))
        print(f"{stage}: {said} (at least {wide} wide operations, {single} single ones)")
    return int(failed > 0)


sys.exit(main(next(path for path in sys.argv[1].split(";") if "/stages.cpp" in path)))
