# The textures that ship: laws of their functions, and the texture tool's text of each on both panels.
house_test(library_noise_test LIBRARIES common SOURCES library_noise_test.cpp)
house_test(library_cells_test LIBRARIES common SOURCES library_cells_test.cpp)

set(LIBRARY_TEXTURES blend brick cells checker fbm gabor marble perlin ramp_constant ramp_linear ramp_smooth rust
  scratches simplex triplanar turbulence voronoi wood worley)
set(LIBRARY_SOURCES ${PROJECT_SOURCE_DIR}/texture_tool/library)
set(LIBRARY_GENERATED ${CMAKE_CURRENT_BINARY_DIR}/library)
set(includes_cpp)
set(includes_cl)
foreach(texture ${LIBRARY_TEXTURES})
  set(out ${LIBRARY_GENERATED}/${texture})
  add_custom_command(OUTPUT ${out}.cl ${out}.hpp ${out}.json
    COMMAND diptych-texture ${LIBRARY_SOURCES}/${texture}.c --id ${texture} --opencl ${out}.cl --cpp ${out}.hpp
      --json ${out}.json
    DEPENDS ${LIBRARY_SOURCES}/${texture}.c VERBATIM)
  list(APPEND LIBRARY_TEXTS ${out}.cl ${out}.hpp)
  string(APPEND includes_cpp "#include \"${out}.hpp\"\n")
  string(APPEND includes_cl "#include \"${out}.cl\"\n")
endforeach()
file(CONFIGURE OUTPUT ${LIBRARY_GENERATED}/library_textures.hpp CONTENT "${includes_cpp}")
file(CONFIGURE OUTPUT ${LIBRARY_GENERATED}/library_textures.cl CONTENT "${includes_cl}")
add_custom_target(library_texts DEPENDS ${LIBRARY_TEXTS})

foreach(loops scalar vector)
  add_library(library_loops_${loops} OBJECT library_loops.cpp)
  add_dependencies(library_loops_${loops} library_texts)
  target_include_directories(library_loops_${loops} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/common/as_cpp
    ${LIBRARY_GENERATED})
  target_compile_options(library_loops_${loops} PRIVATE -w ${HOUSE_ARITHMETIC} -fwrapv
    $<$<CXX_COMPILER_ID:GNU>:-Wno-narrowing> $<$<CXX_COMPILER_ID:Clang>:-Wno-c++11-narrowing>)
endforeach()
target_compile_definitions(library_loops_scalar PRIVATE LOOPS=loops_scalar ALWAYS_INLINE=)
target_compile_options(library_loops_scalar PRIVATE -O1 -fno-tree-vectorize)
target_compile_definitions(library_loops_vector PRIVATE LOOPS=loops_vector
  "ALWAYS_INLINE=__attribute__((always_inline))")
target_compile_options(library_loops_vector PRIVATE -O3 -march=native -fopenmp-simd)

if(WITH_OPENCL)
  set(LIBRARY_KERNELS ${LIBRARY_GENERATED}/library_kernels.cl)
  add_custom_command(OUTPUT ${LIBRARY_KERNELS}
    COMMAND ${CMAKE_C_COMPILER} -E -P -x c -I${PROJECT_SOURCE_DIR} -I${PROJECT_SOURCE_DIR}/common/as_opencl
      -I${LIBRARY_GENERATED} ${CMAKE_CURRENT_SOURCE_DIR}/library_kernels.cl -o ${LIBRARY_KERNELS}
    DEPENDS library_kernels.cl library_hooks.h ${LIBRARY_TEXTS} VERBATIM)
  house_test(library_parity_test LIBRARIES common library_loops_scalar library_loops_vector OpenCL::OpenCL
    nlohmann_json::nlohmann_json SOURCES library_parity_test.cpp ${LIBRARY_KERNELS})
  target_compile_definitions(library_parity_test PRIVATE LIBRARY_KERNELS="${LIBRARY_KERNELS}"
    LIBRARY_GENERATED="${LIBRARY_GENERATED}" LIBRARY_SOURCES="${LIBRARY_SOURCES}"
    LIBRARY_MANUAL="${PROJECT_SOURCE_DIR}/docs/texture-library.md")
endif()

add_test(NAME library_foreign_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/library_foreign_test.py
  ${PROJECT_SOURCE_DIR})
