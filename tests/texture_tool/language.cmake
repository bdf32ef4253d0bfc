# The language from outside: textures in foreign programs of ten lines, which must give the same bits as scalar C++
# without optimisation, as optimised C++ and as OpenCL.
set(LANGUAGE_GENERATED ${CMAKE_CURRENT_BINARY_DIR}/language)
file(MAKE_DIRECTORY ${LANGUAGE_GENERATED})
set(HOSTILE_TEXTURES forms joined_vectors everything defined_results misbehaving)  # run under the sanitizers and Oclgrind
foreach(texture paper_attributes paper_two_images predecessor forms joined_vectors everything defined_results misbehaving)
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/textures/${texture}.c)
  set(out ${LANGUAGE_GENERATED}/${texture})
  add_custom_command(OUTPUT ${out}.cl ${out}.hpp ${out}.json
    COMMAND diptych-texture ${source} --opencl ${out}.cl --cpp ${out}.hpp --json ${out}.json
    DEPENDS ${source} diptych-texture VERBATIM)
  set(programs)
  set(levels 0 3)
  if(texture IN_LIST HOSTILE_TEXTURES)
    list(APPEND levels sanitized)
  endif()
  foreach(level ${levels})
    set(program foreign_${texture}_${level})
    add_executable(${program} foreign_program.cpp ${out}.hpp)
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/common/as_cpp)
    target_compile_definitions(${program} PRIVATE ALWAYS_INLINE= TEXTURE_TEXT="${out}.hpp")
    if(level STREQUAL sanitized)
      set(how -O1 -fsanitize=address,undefined -fno-sanitize=float-divide-by-zero -fno-sanitize-recover=all)
      target_link_options(${program} PRIVATE -fsanitize=address,undefined)
    else()
      set(how -O${level})
    endif()
    target_compile_options(${program} PRIVATE ${how} -w ${HOUSE_ARITHMETIC} -fwrapv
      $<$<CXX_COMPILER_ID:GNU>:-Wno-narrowing> $<$<CXX_COMPILER_ID:Clang>:-Wno-c++11-narrowing>)
    list(APPEND programs $<TARGET_FILE:${program}>)
  endforeach()
  set(opencl)
  if(WITH_OPENCL)
    add_custom_command(OUTPUT ${out}_kernel.cl
      COMMAND ${CMAKE_C_COMPILER} -E -P -x c -DTEXTURE_TEXT="${out}.cl" -I${PROJECT_SOURCE_DIR}
        -I${PROJECT_SOURCE_DIR}/common/as_opencl ${CMAKE_CURRENT_SOURCE_DIR}/foreign_program.cl -o ${out}_kernel.cl
      DEPENDS foreign_program.cl foreign_hooks.h ${out}.cl VERBATIM)
    add_custom_target(foreign_kernel_${texture} ALL DEPENDS ${out}_kernel.cl)
    set(opencl $<TARGET_FILE:foreign_opencl> ${out}_kernel.cl)
    if(texture IN_LIST HOSTILE_TEXTURES)
      set(unwatched)
      if(texture STREQUAL joined_vectors)  # see there
        set(unwatched SKIP_UNINITIALIZED)
      endif()
      house_oclgrind_test(texture_oclgrind_${texture} ${unwatched} $<TARGET_FILE:foreign_opencl> ${out}_kernel.cl)
    endif()
  endif()
  add_test(NAME texture_language_${texture}
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/foreign_test.py ${programs} -- ${opencl})
endforeach()
if(WITH_OPENCL)
  add_executable(foreign_opencl foreign_opencl.cpp)
  target_link_libraries(foreign_opencl PRIVATE OpenCL::OpenCL)
  target_compile_options(foreign_opencl PRIVATE ${HOUSE_WARNINGS} -Wno-ignored-attributes)
endif()
add_test(NAME texture_tool_tx_test COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/tx_test.py
  $<TARGET_FILE:diptych-texture> ${PROJECT_SOURCE_DIR})
