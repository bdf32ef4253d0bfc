# Turns the preprocessor's output TEXT into EMBEDDED, a C++ file with an array of its lines; TEXT is rewritten to what the
# array holds. Markers become #line directives, which every OpenCL compiler knows, with paths relative to ROOT.
file(READ ${TEXT} source)
string(REGEX REPLACE "\n# ([0-9]+) (\"[^\"\n]*\")[^\n]*" "\n#line \\1 \\2" source "\n${source}")
string(REPLACE "\"${ROOT}/" "\"" source "${source}")
string(REGEX REPLACE "\n#line (0 |[0-9]+ \"<)[^\n]*" "" source "${source}")
string(REGEX REPLACE "\n#define (__STDC|STAGE|WHEN)[^\n]*" "" source "${source}")
string(REGEX REPLACE "^\n" "" source "${source}")
file(WRITE ${TEXT} "${source}")

string(REPLACE "\\" "\\\\" source "${source}")
string(REPLACE "\"" "\\\"" source "${source}")
string(REPLACE "\n" "\\n\",\n\"" source "${source}")
file(WRITE ${EMBEDDED}
  "namespace diptych {\nextern const char* const ${STAGE}_lines[];\n"
  "const char* const ${STAGE}_lines[] = {\n\"${source}\",\nnullptr};\n}  // namespace diptych\n")
