# OpenCV by its parts: libraries and headers, without the CMake package of OpenCV. On Debian that one comes with
# libopencv-dev only, which installs all modules. Defines targets of the same names: opencv_core, ...
find_path(OpenCV_INCLUDE_DIR opencv2/core/version.hpp PATH_SUFFIXES opencv4)
set(OpenCV_VERSION)
if(OpenCV_INCLUDE_DIR)
  file(READ ${OpenCV_INCLUDE_DIR}/opencv2/core/version.hpp version_header)
  foreach(part MAJOR MINOR REVISION)
    string(REGEX MATCH "#define CV_VERSION_${part} +([0-9]+)" _ "${version_header}")
    list(APPEND OpenCV_VERSION ${CMAKE_MATCH_1})
  endforeach()
  list(JOIN OpenCV_VERSION "." OpenCV_VERSION)
endif()

foreach(part ${OpenCV_FIND_COMPONENTS})
  find_library(OpenCV_${part}_LIBRARY opencv_${part})
  if(OpenCV_${part}_LIBRARY)
    set(OpenCV_${part}_FOUND TRUE)
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV
  REQUIRED_VARS OpenCV_INCLUDE_DIR VERSION_VAR OpenCV_VERSION HANDLE_COMPONENTS)

foreach(part ${OpenCV_FIND_COMPONENTS})
  if(OpenCV_${part}_FOUND AND NOT TARGET opencv_${part})
    add_library(opencv_${part} UNKNOWN IMPORTED)
    set_target_properties(opencv_${part} PROPERTIES
      IMPORTED_LOCATION ${OpenCV_${part}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OpenCV_INCLUDE_DIR})
  endif()
endforeach()
