// The rows of PATH_BUFFERS as data, for code that treats all planes alike.
#pragma once

#include "platform.h"

#include "common/buffers.h"

#include <iterator>

namespace diptych {

enum class Life { carried, bounce, sample };

struct PathRow {
    const char* name;
    Life life;
    int components;
    bool is_real;  // float or double; else int
};

inline constexpr PathRow path_rows[] = {
#define PATH_ROW(type, name, life) \
    {#name, Life::life, (#type[0] == 'f' && #type[5] == '3') ? 3 : 1, #type[0] == 'f'},
    PATH_BUFFERS(PATH_ROW)
#undef PATH_ROW
};
inline constexpr int path_row_count = int(std::size(path_rows));

#define COUNT_TEXTURE_ROW(type, name) +1
inline constexpr int texture_rows = 0 TEXTURE_BUFFERS(COUNT_TEXTURE_ROW);
#undef COUNT_TEXTURE_ROW

enum PathRowName {
#define PATH_ROW_NAME(type, name, life) row_##name,
    PATH_BUFFERS(PATH_ROW_NAME)
#undef PATH_ROW_NAME
};

}  // namespace diptych
