# What every target of the house has in common. Contraction is off everywhere: a fused multiply-add on one side only would
# make the two panels differ.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(HOUSE_WARNINGS -Wall -Wextra -Wpedantic -Werror)
set(HOUSE_ARITHMETIC -ffp-contract=off -fno-math-errno -fno-trapping-math)

# The flags by which this build is watched by the address and undefined-behaviour sanitizers; none, as a rule.
string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
string(REGEX MATCHALL "-f[a-z-]*sanitize[^ ]*" HOUSE_SANITIZERS "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}")
if(HOUSE_SANITIZERS MATCHES "thread")
  set(HOUSE_SANITIZERS)
endif()

# house_library(NAME sources...): a static library with the house's warnings and include root.
function(house_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${name} PRIVATE ${HOUSE_WARNINGS} ${HOUSE_ARITHMETIC})
endfunction()

# house_test(NAME LIBRARIES libs... SOURCES sources...): a GoogleTest executable, registered with CTest under its own name.
# Its own sources are optimised little, for the sake of building them; what they test is not.
function(house_test name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;SOURCES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
  target_compile_options(${name} PRIVATE ${HOUSE_WARNINGS} ${HOUSE_ARITHMETIC} $<$<CONFIG:Release>:-O1>)
  add_test(NAME ${name} COMMAND ${name})
endfunction()

# house_oclgrind_test(NAME [SKIP_UNINITIALIZED] COMMAND...): the program on Oclgrind's device, without a finding (SKIP_UNINITIALIZED:
# reads of uninitialised memory are not looked for); skipped, and said so, where there is no Oclgrind: Debian 13 has none.
function(house_oclgrind_test name)
  cmake_parse_arguments(ARG "SKIP_UNINITIALIZED" "" "" ${ARGN})
  set(watched --data-races --check-api)
  if(NOT ARG_SKIP_UNINITIALIZED)
    list(APPEND watched --uninitialized)
  endif()
  find_program(OCLGRIND oclgrind)
  if(NOT OCLGRIND)
    add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: no oclgrind here (Debian 12 has a package, Debian 13 none)")
    set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
    return()
  endif()
  # unoptimised: Oclgrind does not know some intrinsics that the optimiser finds
  add_test(NAME ${name} COMMAND ${OCLGRIND} --build-options -cl-opt-disable ${watched} ${ARG_UNPARSED_ARGUMENTS})
  set_tests_properties(${name} PROPERTIES
    FAIL_REGULAR_EXPRESSION "Invalid ;[Uu]ninitialized ;data race;ERROR;FAILED;runtime error;SKIPPED")
endfunction()

# Takes folders that do not exist off an imported target's include path: Debian's OpenImageIO names OpenCV's, whether
# OpenCV is installed or not, and CMake stops at that.
function(house_drop_missing_includes target)
  foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders ${target} ${property})
    set(present)
    foreach(folder IN LISTS folders)
      if(EXISTS "${folder}")
        list(APPEND present "${folder}")
      endif()
    endforeach()
    set_target_properties(${target} PROPERTIES ${property} "${present}")
  endforeach()
endfunction()
