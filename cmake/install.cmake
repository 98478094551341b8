# The programs install themselves (milepost_program). Here: the client library, what of schema it
# is made of, and the package file that lets another project say find_package(milepost) and link
# milepost::client.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(MILEPOST_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/milepost)

# milepost_install_library(NAME FOLDER...): the library milepost::NAME and the headers of FOLDERs.
function(milepost_install_library name)
  install(TARGETS milepost_${name} EXPORT milepost ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  foreach(folder IN LISTS ARGN)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/milepost/${folder}
      FILES_MATCHING PATTERN "*.h")
  endforeach()
endfunction()

milepost_install_library(base schema/base)
milepost_install_library(geo schema/geo)
milepost_install_library(feature_types schema/feature)
milepost_install_library(feature)
milepost_install_library(tile schema/tile)
milepost_install_library(store schema/store)
milepost_install_library(cache client/cache)
milepost_install_library(fetch client/fetch)
milepost_install_library(localize client/localize)
milepost_install_library(global client/global)
milepost_install_library(client)

install(EXPORT milepost NAMESPACE milepost:: FILE milepost-targets.cmake
  DESTINATION ${MILEPOST_PACKAGE_DIR})
configure_package_config_file(cmake/milepost-config.cmake.in milepost-config.cmake
  INSTALL_DESTINATION ${MILEPOST_PACKAGE_DIR})
write_basic_package_version_file(milepost-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/milepost-config.cmake
  ${PROJECT_BINARY_DIR}/milepost-config-version.cmake
  DESTINATION ${MILEPOST_PACKAGE_DIR})
