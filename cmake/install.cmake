# Programs are installed by milepost_program. This file installs libmilepost, its public headers, a CMake
# package (milepost::milepost, shared; milepost::milepost-static), a pkg-config file, and the documents. Components are
# the packages of cmake/packages.cmake.
include(CMakePackageConfigHelpers)

set(MILEPOST_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/milepost)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/include/milepost
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libmilepost-dev FILES_MATCHING PATTERN "*.h")
foreach(kind shared static)
  install(TARGETS milepost_${kind} EXPORT milepost-${kind}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libmilepost NAMELINK_COMPONENT libmilepost-dev
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libmilepost-dev)
  install(EXPORT milepost-${kind} NAMESPACE milepost:: FILE milepost-${kind}-targets.cmake
    DESTINATION ${MILEPOST_PACKAGE_DIR} COMPONENT libmilepost-dev)
endforeach()

configure_package_config_file(cmake/milepost-config.cmake.in milepost-config.cmake
  INSTALL_DESTINATION ${MILEPOST_PACKAGE_DIR})
write_basic_package_version_file(milepost-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/milepost-config.cmake cmake/FindOpenCV.cmake
  ${PROJECT_BINARY_DIR}/milepost-config-version.cmake
  DESTINATION ${MILEPOST_PACKAGE_DIR} COMPONENT libmilepost-dev)

# Relocatable: the prefix is computed relative to the location of the .pc file.
file(RELATIVE_PATH MILEPOST_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/milepost.pc.in milepost.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/milepost.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT libmilepost-dev)

file(GLOB documents ${PROJECT_SOURCE_DIR}/schema/*.md ${PROJECT_SOURCE_DIR}/schema/*.fbs ${PROJECT_SOURCE_DIR}/schema/*.sql)
install(FILES ${documents} schema/openapi.yaml DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/milepost COMPONENT milepost-doc)
