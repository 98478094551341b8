# milepost_man_page(PROGRAM): builds and installs the manual page of a program, from its --help. Not of programs with
# sanitizers, which are for tests, and not where they cannot run.
function(milepost_man_page program)
  if(MILEPOST_SANITIZE OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  set(page ${CMAKE_CURRENT_BINARY_DIR}/${program}.1.gz)
  set(writer ${PROJECT_SOURCE_DIR}/cmake/man_page.py)
  add_custom_command(OUTPUT ${page}
    COMMAND ${MILEPOST_PYTHON} ${writer} $<TARGET_FILE:${program}> ${PROJECT_VERSION} ${page}
    DEPENDS ${program} ${writer} VERBATIM)
  add_custom_target(${program}-man ALL DEPENDS ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${program})
endfunction()
