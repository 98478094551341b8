# Run by CPack on the packages that it has built. dpkg-deb builds them again with what CPack 3.25 cannot do: the field
# Multi-Arch, ldconfig by the trigger alone, and times that are those of SOURCE_DATE_EPOCH.
foreach(package IN LISTS CPACK_PACKAGE_FILES)
  set(tree ${package}.tree)
  file(REMOVE_RECURSE ${tree})
  execute_process(COMMAND dpkg-deb --raw-extract ${package} ${tree} COMMAND_ERROR_IS_FATAL ANY)

  foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER CPACK_DEBIAN_${component}_PACKAGE prefix)
    if(package MATCHES "/${${prefix}_NAME}_[^/]*$" AND ${prefix}_MULTIARCH)
      file(READ ${tree}/DEBIAN/control control)
      file(WRITE ${tree}/DEBIAN/control "Multi-Arch: ${${prefix}_MULTIARCH}\n${control}")
    endif()
  endforeach()
  if(EXISTS ${tree}/DEBIAN/triggers)
    file(REMOVE ${tree}/DEBIAN/postinst ${tree}/DEBIAN/postrm)
  endif()
  if(DEFINED ENV{SOURCE_DATE_EPOCH})
    execute_process(COMMAND find ${tree} -exec touch --no-dereference --date @$ENV{SOURCE_DATE_EPOCH} {} +
      COMMAND_ERROR_IS_FATAL ANY)
  endif()

  execute_process(COMMAND dpkg-deb --root-owner-group -Z${CPACK_MILEPOST_COMPRESSION} --build ${tree} ${package}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE ${tree})
endforeach()
