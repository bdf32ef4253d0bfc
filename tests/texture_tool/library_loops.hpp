// The library's textures as C++, compiled in two ways from library_loops.cpp.
#pragma once

#include <cstdint>
#include <map>
#include <string>

// Evaluates `count` hits, HIT_FLOATS planes of floats, with the arguments in `words`, whose region
// begins at word 0: four planes of results, and how many indexes were brought inside.
using LibraryLoop = void (*)(const float* hits, const std::uint32_t* words, int count,
                             float* results, int* clamped);
using LibraryLoops = std::map<std::string, LibraryLoop>;

const LibraryLoops& loops_scalar();
const LibraryLoops& loops_vector();
