"""Every loop of every shared stage runs over paths in 256- or 512-bit vectors, and so do those of texture rays.

Usage: vectorised_test.py OBJECTS   (a list with ; of kernels_cpu/stages.cpp and texture_ray_loops.cpp compiled for
the vector kernels)

A loop that the compiler leaves scalar still has a few wide moves, which copy structures, but no wide
arithmetic; so arithmetic, comparisons and gathers on wide registers are counted in the machine code
of each. Prints `stage: vectorised` or `stage: not vectorised ...` for each stage.
"""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# The smallest loop, scale_light, has 7 wide operations when vectorised by g++ 12, 4 by g++ 14: a comparison and
# three products.
LEAST = 6
LEAST_OF_GXX_14 = {"scale_light": 4}
# Only adds up memory, and has a loop over layers in each path's turn, which g++ leaves scalar.
SCALAR = {"accumulate_aovs"}
# The loops of texture_ray_loops.cpp; texture_rays only hands its requests to store_rays.
RAY_LOOPS = ("texture_programs", "texture_places", "store_rays")
# Operations on one number at a time: in a loop in lanes those of constants, and of the last few paths.
SINGLE = re.compile(r"v(add|sub|mul|div|sqrt|min|max|comi|ucomi|cmp\w*)ss\b")
# Instructions that only bring values to their places.
PLACING = re.compile(r"v(mov|insert|extract|perm|unpck|punpck|shuf|pshuf|broadcast|pbroadcast|zero|align)")


def shared_stages():
    with open(os.path.join(ROOT, "common/stages/stages.h"), encoding="utf-8") as text:
        return [stage for stage in re.findall(r"X\((\w+), shared,", text.read()) if stage not in SCALAR]


def wide_operations(path, pattern):
    """(name, variant) -> numbers of wide and of single operations in the machine code of its loop."""
    command = ["objdump", "-d", "--no-show-raw-insn", "-C", path]
    code = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    counts, current = {}, None
    for line in code.splitlines():
        if line.endswith(">:"):
            found = re.search(pattern, line)
            current = (found[1], int(found[2] or 0)) if found else None
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


def least_by_loop(path):
    """Wide operations of the loops that need not have LEAST of them, by the compiler of this object."""
    comment = subprocess.run(["readelf", "-p", ".comment", path], capture_output=True, text=True).stdout
    version = re.search(r"GCC: .* (\d+)\.\d+\.\d+", comment)
    return LEAST_OF_GXX_14 if version and int(version[1]) >= 14 else {}


def has_avx2():
    with open("/proc/cpuinfo", encoding="utf-8") as text:
        return " avx2 " in text.read()


def report(names, counts, leasts):
    """Prints how each loop is, and returns how many are not as they should be."""
    failed = 0
    for name in names:
        loops = {variant: count for (of, variant), count in counts.items() if of == name}
        least = leasts.get(name, LEAST)
        scalar = sorted(variant for variant, (wide, single) in loops.items() if wide < max(least, single / 4))
        failed += not loops or bool(scalar)
        said = "vectorised" if loops and not scalar else f"not vectorised: variants {scalar} of {len(loops)}"
        wide, single = min(loops.values(), default=(0, 0))
        print(f"{name}: {said} (at least {wide} wide operations, {single} single ones)")
    return failed


def main(objects):
    stages, rays = (next(path for path in objects if name in path) for name in ("/stages.cpp", "/texture_ray_loops.cpp"))
    reason = reason_to_skip(stages)
    if reason:
        print(f"skipped: {reason}")
        return 77
    failed = report(shared_stages(), wide_operations(stages, r"(\w+)_loop<(\d+)>"), least_by_loop(stages))
    failed += report(RAY_LOOPS, wide_operations(rays, f"({'|'.join(RAY_LOOPS)})(?:<(\\d+)u?>)?\\("), {})
    return int(failed > 0)


sys.exit(main(sys.argv[1].split(";")))
