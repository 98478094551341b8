# Installs the build in BUILD into a prefix under WORK, then builds and runs programs that use only this
# prefix: with CMake (shared, static), with pkg-config (shared, static), and the example. Checks what is
# installed: only the public headers, each of which compiles alone as C++17, and a shared library that
# exports only the public interface.
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)

macro(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endmacro()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

# Headers.
file(GLOB_RECURSE installed RELATIVE ${prefix}/include ${prefix}/include/*)
file(GLOB public RELATIVE ${SOURCE}/client/include ${SOURCE}/client/include/milepost/*.h)
list(SORT installed)
list(SORT public)
if(NOT installed STREQUAL public OR installed STREQUAL "")
  message(FATAL_ERROR "the installed headers are\n${installed}\nbut the public headers are\n${public}")
endif()
foreach(header IN LISTS installed)
  file(WRITE ${WORK}/alone.cc "#include <${header}>\n")
  run(${CXX} -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I${prefix}/include ${WORK}/alone.cc)
  file(STRINGS ${prefix}/include/${header} foreign REGEX "#include <(opencv2|Eigen|nlohmann|sqlite3)")
  if(foreign)
    message(FATAL_ERROR "${header} includes ${foreign}")
  endif()
endforeach()

# Exported symbols of the shared library.
file(GLOB_RECURSE shared ${prefix}/*/libmilepost.so)
execute_process(COMMAND nm -D --defined-only -C ${shared} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "\n$" "" symbols "${symbols}")
string(REPLACE ";" "," symbols "${symbols}")
string(REPLACE "\n" ";" symbols "${symbols}")
list(LENGTH symbols count)
foreach(symbol IN LISTS symbols)
  if(NOT symbol MATCHES " A MILEPOST_0$" AND NOT symbol MATCHES " T milepost::vehicle::(name_of|Localizer::|GlobalLocalizer::)"
     OR symbol MATCHES "::Impl::")
    message(FATAL_ERROR "libmilepost.so exports ${symbol}")
  endif()
endforeach()
if(count LESS 10)
  message(FATAL_ERROR "libmilepost.so exports only ${count} symbols")
endif()

# CMake package.
set(consumer ${CMAKE_CURRENT_LIST_DIR}/consumer)
run(${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/consumer -G Ninja
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer ${WORK})
run(${WORK}/consumer/consumer_static ${WORK})

# pkg-config.
file(GLOB_RECURSE pc ${prefix}/*/milepost.pc)
cmake_path(GET pc PARENT_PATH pkgconfig)
cmake_path(GET shared PARENT_PATH libraries)
function(flags_of result)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pkgconfig} pkg-config ${ARGN} milepost
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  set(${result} ${flags} PARENT_SCOPE)
endfunction()
flags_of(dynamic --cflags --libs)
run(${CXX} -std=c++17 ${consumer}/main.cc -o ${WORK}/by_pkg_config ${dynamic} -Wl,-rpath,${libraries})
run(${WORK}/by_pkg_config ${WORK})
flags_of(static --cflags --libs --static)
list(TRANSFORM static REPLACE "^-lmilepost$" "-l:libmilepost.a")
run(${CXX} -std=c++17 ${consumer}/main.cc -o ${WORK}/by_pkg_config_static ${static})
run(${WORK}/by_pkg_config_static ${WORK})

# The example, on a map of the street that states its datum.
run(${CMAKE_COMMAND} -S ${SOURCE}/client/examples -B ${WORK}/example -G Ninja
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK}/example)
file(COPY ${STREET}/street-map DESTINATION ${WORK})
file(READ ${WORK}/street-map/drive.json drive)
string(REGEX REPLACE "^{" "{\"datum\": \"ITRF2014@2020.5\"," drive "${drive}")
file(WRITE ${WORK}/street-map/drive.json "${drive}")
run(${prefix}/bin/milepost-mapper build --drive ${WORK}/street-map --map ${WORK}/street.map)
execute_process(COMMAND ${WORK}/example/localize_drive ${STREET}/street-query ${WORK}/street.map
  OUTPUT_VARIABLE fixes COMMAND_ERROR_IS_FATAL ANY)
if(NOT fixes MATCHES "[1-9][0-9]* of [0-9]+ frames tracked; .*; positions of ITRF2014@2020.5\n$")
  message(FATAL_ERROR "localize_drive says\n${fixes}")
endif()
