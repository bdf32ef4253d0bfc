#!/usr/bin/env python3
"""The texture tool's share of the paper's claims, TX-10 to TX-15, each by its number.

Usage: tx_test.py TOOL ROOT
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

TOOL, ROOT = sys.argv[1:3]
TEXTURES = os.path.join(ROOT, "tests/texture_tool/textures")
SCRATCH = tempfile.mkdtemp()
CXX = {
    "g++": ["-Wno-narrowing"],
    "clang++": ["-Wno-c++11-narrowing"],
}


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(name, text):
    path = os.path.join(SCRATCH, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def run(command):
    return subprocess.run(command, capture_output=True, text=True)


class Texture:
    """What the tool makes of a file."""

    def __init__(self, path, *options, name="t"):
        self.cl, self.hpp, self.json = (os.path.join(SCRATCH, name + end) for end in (".cl", ".hpp", ".json"))
        outputs = ["--id", name, "--opencl", self.cl, "--cpp", self.hpp, "--json", self.json]
        start = time.monotonic()
        self.done = run([TOOL, path, *outputs, *options])
        self.seconds = time.monotonic() - start

    def description(self):
        return json.loads(read(self.json))


def compile_errors(*textures):
    """What the compilers say of textures side by side in one host, in every dialect."""
    hooks = '#include "tests/texture_tool/foreign_hooks.h"\n'
    rest = '#include "common/user_language/as_vectors/arguments.h"\n'
    cpp = '#include "common/user_language/as_cpp/user_language.h"\nnamespace user_language {\n' + hooks + rest
    cpp += "".join(f'#include "{texture.hpp}"\n' for texture in textures) + "}\n"
    cl = '#include "platform.h"\n#include "common/user_language/as_opencl/user_language.h"\n' + hooks + rest
    cl += "".join(f'#include "{texture.cl}"\n' for texture in textures)
    errors = ""
    path = write("host.cpp", cpp)
    for compiler, flags in CXX.items():
        for dialect in ("as_cpp", "as_double") if shutil.which(compiler) else ():
            command = [compiler, "-std=c++20", "-fsyntax-only", "-w", "-DALWAYS_INLINE=", *flags]
            errors += run([*command, f"-I{ROOT}", f"-I{ROOT}/common/{dialect}", path]).stderr
    if shutil.which("clang"):
        command = ["clang", "-x", "cl", "-cl-std=CL1.2", "-target", "spir64", "-fsyntax-only", "-w"]
        errors += run([*command, f"-I{ROOT}", f"-I{ROOT}/common/as_opencl", write("host.cl", cl)]).stderr
    return errors


HELPERS = """
#define SIZE {size}
typedef struct {{ float value; }} Sample;
enum Mode {{ PLAIN, FANCY }};
static const float table[SIZE] = {{1, 2}};
float helper(float x) {{ return x * table[1] + SIZE; }}
float mix(float a, float b, float t) {{ return {sign} * (a + b * t); }}
float4 userProc(float x)
{{
    Sample s = {{ helper(mix(x, 1.0, 0.5)) }};
    return (float4)(s.value + FANCY);
}}
"""


class TextureTool(unittest.TestCase):
    def test_tx_10_same_names_live_in_one_kernel(self):
        a = Texture(write("a.c", HELPERS.format(size=2, sign=1)), name="a")
        b = Texture(write("b.c", HELPERS.format(size=3, sign=-1)), name="b")
        self.assertEqual(a.done.stderr + b.done.stderr, "")
        self.assertEqual(compile_errors(a, b), "")

    def test_truths_have_names(self):
        texture = Texture(write("truth.c", "float3 t() { bool a = true; return (float3)(a && !false ? 1.0f : 0.0f); }\n"))
        self.assertEqual(texture.done.stderr, "")
        self.assertEqual(compile_errors(texture), "")

    def test_tx_11_requests_are_described(self):
        texture = Texture(os.path.join(TEXTURES, "predecessor.c"))
        found = texture.description()
        self.assertEqual(found["entry"], "main")
        self.assertEqual(found["attributes"], ["LocalPos", "TexCoord0", "Normal"])
        self.assertEqual(found["occlusion"], [{"distance": 0, "hemisphere": "upper", "same_object": False}])
        arguments = [(a["name"], a["type"], a["is_array"]) for a in found["arguments"]]
        self.assertEqual(arguments, [("tex", "sam2D", False), ("colors", "float3", True), ("ids", "uint", True),
                                     ("k", "float", True)])
        self.assertTrue(found["images"])

    def test_tx_11_every_attribute_and_synonym(self):
        names = {"float3": "WorldPos LocalPos Normal GeomNormal Tangent Bitangent ViewDir Norm ShadeNorm ModelPos "
                           "Tang Tan Bitang Bitan Binorm",
                 "float2": "TexCoord0 TexCoord1 TexCoord0Dx TexCoord0Dy", "float4": "VertexColor",
                 "int": "ObjectId InstanceId PrimitiveId", "float": "Time AO AO0 AO1"}
        lines = [f'    {type} v{name} = readAttr("{name}");' for type in names for name in names[type].split()]
        texture = Texture(write("all.c", "float4 t(void)\n{\n" + "\n".join(lines) + "\n    return (float4)(vTime);\n}\n"))
        self.assertEqual(texture.done.stderr, "")
        self.assertEqual(len(texture.description()["attributes"]), 16)
        self.assertEqual(compile_errors(texture), "")

    def test_tx_12_the_papers_examples_compile_verbatim(self):
        for name in ("paper_attributes", "paper_two_images"):
            texture = Texture(os.path.join(TEXTURES, name + ".c"))
            self.assertEqual(texture.done.stderr, "")
            self.assertEqual(compile_errors(texture), "")

    def test_every_form_compiles_in_every_dialect(self):
        for name in os.listdir(TEXTURES):
            texture = Texture(os.path.join(TEXTURES, name), name="form")
            self.assertEqual(texture.done.returncode, 0, name + texture.done.stderr)
            self.assertEqual(compile_errors(texture), "", name)

    def test_tx_13_lines_stay_the_users_own(self):
        for name in os.listdir(TEXTURES):
            path = os.path.join(TEXTURES, name)
            texture = Texture(path, name="lines")
            source = read(path).split("\n")
            for generated in (texture.cl, texture.hpp):
                text = read(generated)
                own = text[text.index(f'#line 1 "{path}"'):].split("\n")[1:]
                for number, line in enumerate(source):
                    if re.match(r"float\w* \w+\(", line):
                        self.assertIn(re.match(r"float\w* (\w+)\(", line)[1], own[number])
            found = texture.description()
            self.assertEqual(found["total_lines"], len(source) - 1)
            self.assertLessEqual(found["changed_lines"], found["total_lines"])
        quiet = Texture(os.path.join(TEXTURES, "paper_two_images.c")).description()
        self.assertEqual((quiet["changed_lines"], quiet["total_lines"]), (4, 7))

    def test_tx_13_compilers_name_the_users_line(self):
        path = write("late.c", "// first\n\nfloat4 t(float x)\n{\n    return (float4)(x);\n}\n")
        texture = Texture(path)
        text = read(texture.hpp).replace("(x)", "(x, broken)")
        with open(texture.hpp, "w", encoding="utf-8") as file:
            file.write(text)
        self.assertIn(f"{path}:5:", compile_errors(texture))

    def test_tx_15_unmodified_files_compile_in_foreign_programs(self):
        host = os.path.join(ROOT, "tests/texture_tool/foreign_host.c")
        cases = [("foreign_vectors", "make_float3(0.5f, 0.25f, 1.0f)", ("clang", "g++", "clang++")),
                 ("paper_two_images", "image", ("clang", "gcc", "g++", "clang++"))]
        for name, argument, compilers in cases:
            results = {}
            for compiler in compilers:
                if not shutil.which(compiler):
                    continue
                language = ["-std=c++20", "-x", "c++"] if "++" in compiler else ["-std=c11", "-x", "c"]
                program = os.path.join(SCRATCH, "foreign")
                path = os.path.join(TEXTURES, name + ".c")
                done = run([compiler, *language, "-O1", "-Wall", "-Wno-psabi", f"-I{ROOT}", f'-DTEXTURE="{path}"',
                            f"-DARGUMENT={argument}", host, "-o", program, "-lm"])
                self.assertEqual(done.stderr, "", compiler)
                results[compiler] = run([program]).stdout
            self.assertEqual(len(set(results.values())), 1, results)

    def test_tx_15_vector_literals_are_errors_not_surprises(self):
        path = write("literal.c", '#include "texture_tool/diptych_texture.h"\n'
                                  "float4 t(float x) { return (float4)(x, x, x, 1.0f); }\n")
        for compiler in ("clang", "g++", "clang++"):
            if shutil.which(compiler):
                language = ["-std=c++20", "-x", "c++"] if "++" in compiler else ["-std=c11", "-x", "c"]
                done = run([compiler, *language, "-fsyntax-only", f"-I{ROOT}", path])
                self.assertIn("error", done.stderr, compiler)

    def test_library_functions_need_no_include_and_the_users_own_win(self):
        path = write("uses.c", "float perlin2(float2 p) { return 0.5f; }\n"
                               'float4 t(void) { return (float4)(perlin3(readAttr("WorldPos")), perlin2(1), 0, 1); }\n')
        texture = Texture(path)
        self.assertEqual(texture.done.stderr, "")
        self.assertEqual(compile_errors(texture), "")
        self.assertIn("library/perlin.c", read(texture.cl))

    def test_a_file_name_injects_nothing(self):
        texture = Texture(os.path.join(TEXTURES, "paper_two_images.c"), "--name", 'a"\n#include "/etc/passwd\\')
        self.assertEqual(compile_errors(texture), "")
        self.assertNotIn("\n#include", read(texture.cl) + read(texture.hpp))

    def test_comments_end_where_every_compiler_ends_them(self):
        path = write("comment.c", "float4 t(float x)\n{\n    // ??/\n    x = 1.0f;\n    // \\\n    evil();\n"
                                  "    return (float4)(x);\n}\n")
        texture = Texture(path)
        self.assertEqual(texture.done.stderr, "")
        self.assertNotIn("evil", read(texture.cl) + read(texture.hpp))
        self.assertEqual(compile_errors(texture), "")

    def test_what_c_leaves_open_has_the_documented_result(self):
        path = write("open.c", """
float nothing(float x) { if (x > 1e30f) return 7; }
float4 t(void)
{
    int zero = (int)(readAttr("WorldPos").x * 0.0f), low = -2147483647 - 1, unset;
    float nan = sqrt(zero - 1.0f);
    int good = unset == 0 && nothing(zero) == 0 && low - 1 + zero == 2147483647 && -low == low;
    good = good && 7 / zero == 0 && 7 % zero == 7 && low / (zero - 1) == low && low % (zero - 1) == 0;
    good = good && 1 << (zero + 33) == 2 && low >> (zero + 35) == low >> 3 && 1 << -1 == low;
    good = good && (int)1e20f == 2147483647 && (int)-1e20f == low && (int)-1.5f == -1 && (int)nan == 0;
    good = good && (uint)-5.0f == 0 && (uint)1e20f == 4294967295u && (uint)nan == 0;
    return good && smoothstep(1.0f, 0.0f, 0.25f) == 0.84375f && smoothstep(1.0f, 1.0f, 2.0f) == 1 ? 1.0f : 0.0f;
}
""")
        texture = Texture(path, name="texture")
        program = os.path.join(SCRATCH, "open")
        done = run(["g++", "-std=c++20", "-O1", "-w", "-fwrapv", "-ffp-contract=off", "-DALWAYS_INLINE=", f"-I{ROOT}",
                    f"-I{ROOT}/common/as_cpp", f'-DTEXTURE_TEXT="{texture.hpp}"', "-o", program,
                    os.path.join(ROOT, "tests/texture_tool/foreign_program.cpp")])
        self.assertEqual(done.stderr, "")
        self.assertEqual(set(run([program]).stdout.splitlines()), {"1 1 1 1 0 0"})

    def test_pragmas_and_byte_order_marks_change_nothing(self):
        path = write("pragmas.c", "\ufeff#pragma weak system // \\\n    evil\n#pragma pack(1) /*\n*/ float4 oops\n"
                                  "float4 t(float x) { return (float4)(x); }\n")
        texture = Texture(path)
        self.assertEqual(texture.done.returncode, 0, texture.done.stderr)
        self.assertEqual(texture.done.stderr.count("this #pragma has no effect"), 2)
        for word in ("weak", "evil", "oops"):
            self.assertNotIn(word, read(texture.cl) + read(texture.hpp))
        self.assertEqual(compile_errors(texture), "")

    def test_structs_without_a_name_are_written_in_every_dialect(self):
        path = write("structs.c", "struct Pair { float a, b; };\n"
                                  "float sum(const struct Pair p) { return p.a + p.b; }\n"
                                  "float4 t(float x)\n{\n    struct Pair p = (struct Pair){x, 2};\n"
                                  "    return (float4)(sum(p) + ((const struct Pair){3, 4}).b);\n}\n")
        texture = Texture(path)
        self.assertEqual(texture.done.stderr, "")
        self.assertEqual(compile_errors(texture), "")

    def test_a_file_takes_less_than_a_third_of_a_second(self):
        path = os.path.join(TEXTURES, "everything.c")
        self.assertLess(min(Texture(path).seconds for _ in range(5)), 0.3)

    def test_the_same_file_gives_the_same_text(self):
        path = os.path.join(TEXTURES, "forms.c")
        texts = [read(texture.cl) + read(texture.hpp) for texture in (Texture(path), Texture(path))]
        self.assertEqual(*texts)


if __name__ == "__main__":
    try:
        unittest.main(argv=sys.argv[:1])
    finally:
        shutil.rmtree(SCRATCH)
