# Packages of Debian by CPack, one per component of the installation: deploy/package builds them. What only a package
# has (units, copyright, changelogs) is left out by cmake --install.
find_program(MILEPOST_DPKG dpkg-deb)
if(NOT MILEPOST_DPKG)
  return()
endif()

set(MILEPOST_DEBIAN ${PROJECT_SOURCE_DIR}/deploy/debian)
set(MILEPOST_PACKAGED ${PROJECT_BINARY_DIR}/debian)  # files made for the packages
set(MILEPOST_DOC ${CMAKE_INSTALL_DATAROOTDIR}/doc)
set(MILEPOST_DEBIAN_REVISION 0milepost1)  # not Debian's own: theirs would begin with 1 and be newer

function(milepost_gzip file out)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${out} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The licence in `file`, as a paragraph of a copyright file.
function(milepost_licence_paragraph variable file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(STRIP "${text}" text)
  string(REPLACE "\n\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text "${text}")
  set(${variable} " ${text}" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${MILEPOST_PACKAGED})
milepost_gzip(${MILEPOST_DEBIAN}/changelog ${MILEPOST_PACKAGED}/changelog.Debian.gz)
milepost_gzip(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${MILEPOST_PACKAGED}/changelog.gz)
milepost_licence_paragraph(LEAFLET_LICENCE ${PROJECT_SOURCE_DIR}/server/viewer/leaflet-licence.txt)
milepost_licence_paragraph(CHART_LICENCE ${PROJECT_SOURCE_DIR}/schema/page/chart.js-licence.txt)
configure_file(${MILEPOST_DEBIAN}/copyright.in ${MILEPOST_PACKAGED}/copyright)

# milepost_package(COMPONENT NAME ... FIELD VALUE ... DESCRIPTION ...): the package NAME of a component. The description's
# first line is the summary.
function(milepost_package component)
  cmake_parse_arguments(ARG "" "NAME;SECTION;ARCHITECTURE;MULTIARCH;DEPENDS;RECOMMENDS;SUGGESTS;DESCRIPTION" "CONTROL" ${ARGN})
  string(TOUPPER CPACK_DEBIAN_${component} prefix)
  foreach(field NAME SECTION ARCHITECTURE MULTIARCH DEPENDS RECOMMENDS SUGGESTS)
    if(ARG_${field})
      set(${prefix}_PACKAGE_${field} "${ARG_${field}}" PARENT_SCOPE)
    endif()
  endforeach()
  set(${prefix}_DESCRIPTION "${ARG_DESCRIPTION}" PARENT_SCOPE)
  set(${prefix}_PACKAGE_CONTROL_EXTRA "${ARG_CONTROL}" PARENT_SCOPE)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} PARENT_SCOPE)

  install(FILES ${MILEPOST_PACKAGED}/copyright ${MILEPOST_PACKAGED}/changelog.gz ${MILEPOST_PACKAGED}/changelog.Debian.gz
    DESTINATION ${MILEPOST_DOC}/${ARG_NAME} COMPONENT ${component} EXCLUDE_FROM_ALL)
  set(overrides ${MILEPOST_DEBIAN}/${component}/lintian-overrides)
  if(EXISTS ${overrides})
    install(FILES ${overrides} DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/lintian/overrides RENAME ${ARG_NAME}
      COMPONENT ${component} EXCLUDE_FROM_ALL)
  endif()
endfunction()

set(about
"milepost localizes a vehicle on its road with one forward camera, to a few
centimetres, against a compact map made from recorded drives.
")

milepost_package(milepost-mapper NAME milepost-mapper SECTION science
  RECOMMENDS milepost-doc SUGGESTS milepost-server DESCRIPTION
"maps for camera localization from recorded drives
${about}
The mapper imports recordings of other programs (SBET, tables, NMEA, GPX,
KITTI, COLMAP, ROS) and builds one road network of visual landmarks from
drives. It inspects, verifies and exports maps, and extracts the walls of
buildings from orthoimages.")

milepost_package(milepost-server NAME milepost-server SECTION net
  RECOMMENDS milepost-doc SUGGESTS "milepost-mapper, nginx, prometheus" DESCRIPTION
"HTTP server of maps for camera localization
${about}
The server streams the tiles of maps to vehicles by ranges of arc length. It
takes up new builds while it runs, signs them, writes them out as plain files,
shows its maps to a browser, and tells Prometheus what it counts.
.
The service serves the maps in /srv/milepost on port 8080; its settings are
in /etc/milepost/server.toml."
  CONTROL ${MILEPOST_DEBIAN}/milepost-server/conffiles ${MILEPOST_DEBIAN}/milepost-server/postinst
    ${MILEPOST_DEBIAN}/milepost-server/prerm ${MILEPOST_DEBIAN}/milepost-server/postrm)

milepost_package(milepost-client NAME milepost-client SECTION science
  SUGGESTS "milepost-doc, milepost-server" DESCRIPTION
"camera localization of recorded drives on maps
${about}
The client localizes a recorded drive on the map of a file or a server, with or
without satellite navigation, and evaluates the fixes against the recorded
positions, with a report. Vehicles use the library, libmilepost.")

milepost_package(milepost-simulator NAME milepost-simulator SECTION science
  SUGGESTS "milepost-client, milepost-mapper" DESCRIPTION
"simulated drives for camera localization
${about}
The simulator makes up a town or a city from a seed and renders drives through
it, with true positions, those of a receiver and odometry, and an orthoimage.")

milepost_package(libmilepost NAME libmilepost${PROJECT_VERSION_MAJOR} SECTION libs MULTIARCH same
  CONTROL ${MILEPOST_DEBIAN}/libmilepost/triggers DESCRIPTION
"camera localization in a vehicle - shared library
${about}
The library fetches, checks and caches the map ahead of the vehicle in threads
of its own, and estimates the pose of each frame and its uncertainty.")

milepost_package(libmilepost-dev NAME libmilepost-dev SECTION libdevel MULTIARCH same
  DEPENDS "libmilepost${PROJECT_VERSION_MAJOR} (= ${PROJECT_VERSION}-${MILEPOST_DEBIAN_REVISION})"
  SUGGESTS "milepost-doc, libopencv-features2d-dev, libgeographiclib-dev, libsqlite3-dev, libcurl4-openssl-dev, libzstd-dev, libsodium-dev"
  DESCRIPTION
"camera localization in a vehicle - development files
${about}
This package has the C++17 headers, the static library, files for CMake and
pkg-config, and an example. The shared library needs no other development
files; the static one needs the suggested ones of its dependencies.")

milepost_package(milepost-doc NAME milepost-doc SECTION doc ARCHITECTURE all MULTIARCH foreign DESCRIPTION
"formats and protocol of maps for camera localization
${about}
These are the specifications of drives and maps, of the protocol between
vehicles and servers, and of the findings about drives, with the decisions
behind them, in /usr/share/doc/milepost.")

# The server as a service.
set(server_only COMPONENT milepost-server EXCLUDE_FROM_ALL)
install(FILES deploy/systemd/milepost-server.service deploy/systemd/milepost-server.socket
  DESTINATION lib/systemd/system ${server_only})
install(FILES deploy/systemd/server.toml DESTINATION /etc/milepost ${server_only})
install(FILES deploy/nginx-front.conf deploy/nginx-static.conf DESTINATION ${MILEPOST_DOC}/milepost-server/examples ${server_only})
install(FILES deploy/grafana/milepost-server.json DESTINATION ${MILEPOST_DOC}/milepost-server/examples/grafana ${server_only})


install(DIRECTORY client/examples/ DESTINATION ${MILEPOST_DOC}/libmilepost-dev/examples
  COMPONENT libmilepost-dev EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "milepost founders <founders@milepost.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each component has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${MILEPOST_DEBIAN_REVISION})
set(CPACK_DEBIAN_PACKAGE_SOURCE milepost)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_COMPRESSION_TYPE none)
set(CPACK_POST_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_packages.cmake)
set(CPACK_MILEPOST_COMPRESSION xz)  # of the finished packages
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
