# The programs install themselves (milepost_program). Here: libmilepost, its public headers, and what
# lets another project find it: a CMake package (milepost::milepost, shared; milepost::milepost-static)
# and a pkg-config file.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(MILEPOST_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/milepost)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/include/milepost
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
foreach(kind shared static)
  install(TARGETS milepost_${kind} EXPORT milepost-${kind}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT milepost-${kind} NAMESPACE milepost:: FILE milepost-${kind}-targets.cmake
    DESTINATION ${MILEPOST_PACKAGE_DIR})
endforeach()

configure_package_config_file(cmake/milepost-config.cmake.in milepost-config.cmake
  INSTALL_DESTINATION ${MILEPOST_PACKAGE_DIR})
write_basic_package_version_file(milepost-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/milepost-config.cmake
  ${PROJECT_BINARY_DIR}/milepost-config-version.cmake
  DESTINATION ${MILEPOST_PACKAGE_DIR})

# The package may be moved as a whole: its prefix is told from where its file lies.
file(RELATIVE_PATH MILEPOST_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/milepost.pc.in milepost.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/milepost.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
