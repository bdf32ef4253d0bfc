#!/usr/bin/env python3
"""The library's textures, unmodified, in one foreign program after the one header (TX-15): as C11 with
clang and as C++20 with g++ and clang++.

Usage: library_foreign_test.py SOURCE_FOLDER"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

FAMILIES = ["hash", "perlin", "simplex", "fractal", "worley", "gabor", "ramp"]
COMPILERS = [("clang", "-std=c11", ".c"), ("g++", "-std=c++20", ".cpp"),
             ("clang++", "-std=c++20", ".cpp")]


def main():
    tool = pathlib.Path(sys.argv[1]) / "texture_tool"
    textures = sorted((tool / "library").glob("*.c"))
    assert len(textures) >= 19, f"only {len(textures)} textures in {tool / 'library'}"
    failures = 0
    tried = []
    with tempfile.TemporaryDirectory() as folder:
        for compiler, standard, suffix in COMPILERS:
            if shutil.which(compiler) is None:
                print(f"{compiler}: not on this machine")
                continue
            tried.append(compiler)
            files = [tool / "diptych_texture.h"]
            files += [tool / "library" / "functions" / f"{name}.c" for name in FAMILIES]
            program = pathlib.Path(folder) / f"program{suffix}"
            program.write_text("".join(f'#include "{file}"\n' for file in files + textures))
            run = subprocess.run([compiler, standard, "-fsyntax-only", str(program)],
                                 capture_output=True, text=True, check=False)
            if run.returncode != 0:
                failures += 1
                print(f"{compiler} {standard}\n{run.stderr[:4000]}")
    assert tried, "no compiler on this machine"
    print(f"{len(textures)} textures with {', '.join(tried)}: {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
