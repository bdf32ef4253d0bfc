// The library's textures as C++, compiled in two ways from library_loops.cpp.
#pragma once

#include <cstdint>
#include <map>
#include <string>

// Evaluates `count` hits of HIT_FLOATS floats with the arguments in `words`, whose region begins at
// word 0; four floats of result and the number of indexes brought inside for each.
using LibraryLoop = void (*)(const float* hits, const std::uint32_t* words, int count,
                             float* results, int* clamped);
using LibraryLoops = std::map<std::string, LibraryLoop>;

const LibraryLoops& loops_scalar();
const LibraryLoops& loops_vector();
