# MILEPOST_TESTS: build the tests. Not cached unless it is given, so that the default follows what is installed.
if(NOT DEFINED MILEPOST_TESTS)
  find_package(GTest QUIET)
  set(MILEPOST_TESTS ${GTest_FOUND})
endif()
option(MILEPOST_BENCHMARKS "Build the benchmarks in tests/bench" ON)
option(MILEPOST_WERROR "Treat warnings as errors" OFF)
option(MILEPOST_FUZZ "Build the fuzz targets as libFuzzer programs (clang)" OFF)
set(MILEPOST_SANITIZE "" CACHE STRING "Sanitizers, for example address,undefined or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# Compile options of every target of the project; not exported to users of the library.
add_library(milepost_compile_options INTERFACE)
target_compile_options(milepost_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wno-restrict           # false positives of GCC 12 on std::string (GCC bug 105651)
  -Wno-subobject-linkage  # false positives in unity builds, where a .cc file is not the main file
  $<$<BOOL:${MILEPOST_WERROR}>:-Werror>)
if(MILEPOST_SANITIZE)
  target_compile_options(milepost_compile_options INTERFACE
    -fsanitize=${MILEPOST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -Wno-maybe-uninitialized)  # false positives of GCC 12 on std::regex with sanitizers (GCC bug 105562)
  target_link_options(milepost_compile_options INTERFACE -fsanitize=${MILEPOST_SANITIZE})
endif()

# milepost_library(NAME SOURCES ... PUBLIC ... PRIVATE ...): a library with the alias milepost::NAME.
# Headers are included from the root of the project: #include "schema/base/result.h".
function(milepost_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(milepost_${name} STATIC ${ARG_SOURCES})
  add_library(milepost::${name} ALIAS milepost_${name})
  target_include_directories(milepost_${name} PUBLIC
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
  target_compile_features(milepost_${name} PUBLIC cxx_std_20)
  target_link_libraries(milepost_${name}
    PUBLIC ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE} milepost_compile_options)
endfunction()

# milepost_program(NAME SOURCES ... LINK ...): an installed command, with its manual page.
function(milepost_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} milepost_compile_options)
  install(TARGETS ${name} RUNTIME COMPONENT ${name})
  milepost_man_page(${name})
endfunction()
