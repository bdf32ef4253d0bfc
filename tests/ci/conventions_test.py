"""ci/check_conventions finds each planted fault, at its line, and nothing in what is right.

A tree is made with the real common/ and the real checker, and one file a case added to it.
"""
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# path, content, line of the one violation, a word of its message; or None and None where all is well
CASES = [
    ("common/a.h", '#include "backends/b.hpp"\n', 1, "may only include"),
    ("kernels_cl/a.cl", '#include "kernels_cpu/b.hpp"\n', 1, "may only include"),
    ("kernels_cpu/a.cpp", '\n#include "backends/b.hpp"\n', 2, "may only include"),
    ("backends/a.cpp", '#include "host/b.hpp"\n', 1, "may only include"),
    ("host/render/a.cpp", '#include "backends/opencl/device.hpp"\n', 1, "may only include"),
    ("host/image/a.cpp", '#include "common/layout.h"\n', 1, "may only include"),
    ("host/image/a.cpp", '#include "platform.h"\n', 1, "nothing of ours"),
    ("host/scene/a.cpp", '#include "backends/backend.hpp"\n', 1, "may only include"),
    ("host/a.cpp", '#include "../backends/backend.hpp"\n', 1, "from the root"),
    ("host/a.cpp", "#include <embree3/rtcore.h>\n", 1, "only"),
    ("texture_tool/a.cpp", '#include "common/layout.h"\n', 1, "may only include"),
    ("tests/a.cpp", '#include "backends/backend.hpp"\n', None, None),
    ("host/render/a.cpp", '#include "backends/backend.hpp"\n', None, None),
    ("common/a.h", "#pragma once\n#ifdef WINDOWS\n#endif\n", 2, "condition"),
    ("common/a.h", "SHARED float twice(float x) { return 2.0f * y; }\n", 1, "not C++"),
    ("common/a.h", "SHARED float twice(float x) { return 2.0f * x; }\n", None, None),
    ("common/a.h", "SHARED int one(const int& x) { return x; }\n", 1, "not OpenCL"),
    ("common/a.h", "SHARED float first(float3 v) { return v.xy.x; }\n", 1, "not C++"),
    ("common/a.h", "GLOBAL float* narrow(GLOBAL PLANE(float) * p);\n", None, None),
    ("host/a.cpp", "void f()\n{\n    // return;\n}\n", 3, "commented-out"),
    ("host/a.cpp", "// int count = 0;\n", 1, "commented-out"),
    ("host/a.cpp", "// if (count > 0) {\n", 1, "commented-out"),
    ("host/a.cpp", "// Takes the light, as seen from here;\n// returns nothing.\n", None, None),
    ("host/a.cpp", "// Use it like this:\n//\n//     int count = 0;\n", None, None),
    ("host/a.cpp", "int  a;\n", 1, "not formatted"),
    ("host/a.cpp", "int a;\n\n\n" * 200, 500, "lines"),
    ("docs/a.md", "One  \ntwo\n", 1, "white space"),
    ("docs/a.md", "See /ho" + "me/someone/file.\n", 1, "one machine"),
    ("docs/a.md", "See docs/home/file and /usr/share.\n", None, None),
]


def check(path, content):
    """What the checker says of a tree with this one file added."""
    with tempfile.TemporaryDirectory() as tree:
        for part in ("ci/check_conventions", ".clang-format"):
            os.makedirs(os.path.dirname(os.path.join(tree, part)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, part), os.path.join(tree, part))
        shutil.copytree(f"{ROOT}/common", f"{tree}/common")
        os.makedirs(os.path.dirname(os.path.join(tree, path)), exist_ok=True)
        with open(os.path.join(tree, path), "w", encoding="utf-8") as file:
            file.write(content)
        command = [sys.executable, os.path.join(tree, "ci/check_conventions"), path]
        done = subprocess.run(command, capture_output=True, text=True)
        lines = done.stdout.splitlines()
        assert bool(lines) == (done.returncode == 1), done
        return lines, "formatting not checked" in done.stderr


failed = 0
for path, content, line, word in CASES:
    said, unformatted = check(path, content)
    if word == "not formatted" and unformatted:
        continue
    expected = line is None and not said or any(
        s.startswith(f"{path}:{line}: ") and word in s for s in said
    )
    if not expected:
        failed += 1
        print(f"{path}: {content[:60]!r}: expected {line}, {word!r}; got {said}")
print(f"{len(CASES) - failed} passed, {failed} failed")
sys.exit(failed != 0)
