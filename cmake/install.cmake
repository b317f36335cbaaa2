# SPDX-License-Identifier: Apache-2.0
# `cmake --install` installs components, from which cmake/packages.cmake makes packages: the programs (programs), those of
# them that link GPL libraries (solver), the library for drivers (library) and what building a driver takes (haptic).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(PALPATE_PACKAGED_PREFIX /usr)  # of Debian packages
set(PALPATE_PACKAGE_programs palpate)
set(PALPATE_PACKAGE_solver palpate-solver)
set(PALPATE_PACKAGE_library libpalpate-haptic${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(PALPATE_PACKAGE_haptic libpalpate-haptic-dev)

# --- The library for drivers
install(TARGETS palpate_haptic EXPORT palpateTargets COMPONENT library
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT haptic
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY clients/haptic/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT haptic)
install(FILES ${PALPATE_LISTS_DIR}/palpate_haptic_flags.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT haptic)

set(PALPATE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
set(PALPATE_DATA_DIR ${CMAKE_INSTALL_DATADIR}/palpate)
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${PALPATE_CMAKE_DIR} COMPONENT haptic)
configure_package_config_file(cmake/palpateConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake
  INSTALL_DESTINATION ${PALPATE_CMAKE_DIR} PATH_VARS PALPATE_DATA_DIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
  DESTINATION ${PALPATE_CMAKE_DIR} COMPONENT haptic)
# For pkg-config; the prefix follows from where the file is, as in the CMake package.
string(REGEX REPLACE "[^/]+" ".." PALPATE_PREFIX_FROM_PC ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
configure_file(cmake/palpate-haptic.pc.in ${CMAKE_CURRENT_BINARY_DIR}/palpate-haptic.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate-haptic.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT haptic)

# The description of the wire, for clients in other languages, and the driver template.
install(FILES idl/palpate.idl DESTINATION ${PALPATE_DATA_DIR} COMPONENT haptic)
install(FILES clients/driver_template/CMakeLists.txt clients/driver_template/driver.cpp clients/driver_template/README.md
  DESTINATION ${PALPATE_DATA_DIR}/driver_template COMPONENT haptic)

install(FILES clients/examples/CMakeLists.txt clients/examples/README.md clients/examples/touch.c clients/examples/touch.py
  clients/examples/palpate_qos.xml DESTINATION ${PALPATE_DATA_DIR}/examples COMPONENT haptic)

# --- The programs, each with its man pages and completion
find_program(PALPATE_HELP2MAN help2man)
if(NOT PALPATE_HELP2MAN)
  message(STATUS "no man pages are made: help2man is absent (tools/install_packages installs it)")
endif()

# palpate_install_programs(COMPONENT PROGRAM...)
function(palpate_install_programs COMPONENT)
  set(man ${CMAKE_CURRENT_BINARY_DIR}/man/${COMPONENT})
  foreach(program IN LISTS ARGN)
    add_dependencies(${program} palpate-read-model)  # most load models
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${COMPONENT})
    install(FILES tools/packaging/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
      RENAME ${program} COMPONENT ${COMPONENT})
    add_custom_command(OUTPUT ${man}/${program}.1.gz
      COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tools/packaging/man_pages $<TARGET_FILE:${program}> ${man}
      DEPENDS ${program} tools/packaging/man_pages VERBATIM)
    list(APPEND pages ${man}/${program}.1.gz)
  endforeach()
  # A sanitizer's programs are slow to start, and are not installed.
  if(PALPATE_HELP2MAN AND NOT PALPATE_SANITIZE)
    add_custom_target(man_pages_${COMPONENT} ALL DEPENDS ${pages})
  endif()
  install(DIRECTORY ${man}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${COMPONENT} OPTIONAL)
endfunction()
palpate_install_programs(programs palpate-server palpate-tool palpate-latency palpate-watch palpate-device palpate-parameters
  palpate-list palpate-security palpate-viewer palpate-inspect palpate-fit palpate-feel palpate-replay)
# What links Gmsh or CHOLMOD: README.md, Licence.
palpate_install_programs(solver palpate-organ palpate-solve palpate-query palpate-certify palpate-reproduce)
install(PROGRAMS tools/make/solve/slurm/solve.sbatch tools/make/solve/slurm/batch.sbatch
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${PALPATE_PACKAGE_solver}/examples COMPONENT solver)
# What parses model files for all of them: core/data/ask_reader.cpp looks for it there.
install(TARGETS palpate-read-model RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/palpate COMPONENT programs)

# The page, if it was built (clients/viewer/web).
install(DIRECTORY clients/viewer/web/dist/ DESTINATION ${PALPATE_DATA_DIR}/viewer COMPONENT programs OPTIONAL)

# --- The server as a service
# The unit names what is installed by its absolute path. `cmake --install --prefix DIR` chooses the prefix, so the unit is made
# then. cpack installs below a folder of its own: its packages have the prefix that they unpack to.
configure_file(server/palpate-server.service.in ${CMAKE_CURRENT_BINARY_DIR}/palpate-server.service @ONLY)
install(CODE "
  set(source \"${CMAKE_CURRENT_SOURCE_DIR}/server/palpate-server.service.in\")
  set(packaged_prefix \"${PALPATE_PACKAGED_PREFIX}\")
  set(dir_BINDIR \"${CMAKE_INSTALL_BINDIR}\")
  set(dir_SYSCONFDIR \"${CMAKE_INSTALL_SYSCONFDIR}\")
" COMPONENT programs)
install(CODE [[
  set(prefix "${CMAKE_INSTALL_PREFIX}")
  if(prefix MATCHES /_CPack_Packages/)
    set(prefix "${packaged_prefix}")
  endif()
  get_filename_component(prefix "${prefix}" ABSOLUTE)
  foreach(dir IN ITEMS BINDIR SYSCONFDIR)
    get_filename_component(CMAKE_INSTALL_FULL_${dir} "${dir_${dir}}" ABSOLUTE BASE_DIR "${prefix}")
  endforeach()
  # Written where it belongs: a copy in the build's folder would be root's after sudo, and two installations would share it.
  set(unit_file "${CMAKE_INSTALL_PREFIX}/lib/systemd/system/palpate-server.service")
  message(STATUS "Installing: $ENV{DESTDIR}${unit_file}")
  file(READ "${source}" unit)
  string(CONFIGURE "${unit}" unit @ONLY)
  file(WRITE "$ENV{DESTDIR}${unit_file}" "${unit}")
  file(CHMOD "$ENV{DESTDIR}${unit_file}" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES "${unit_file}")
]] COMPONENT programs)
install(FILES server/palpate-cpu-latency.rules DESTINATION lib/udev/rules.d
  RENAME 60-palpate-cpu-latency.rules COMPONENT programs)
install(FILES server/server.toml DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/palpate COMPONENT programs)
install(FILES server/palpate-limits.conf DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/security/limits.d
  RENAME palpate.conf COMPONENT programs)

# --- Licences, and what tools/package makes: change log and bill of materials
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)  # Debian has its own copy
foreach(component IN ITEMS programs solver library haptic)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${PALPATE_PACKAGE_${component}})
  install(FILES tools/packaging/copyright DESTINATION ${doc} COMPONENT ${component})
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz ${CMAKE_CURRENT_BINARY_DIR}/palpate.spdx.json
    DESTINATION ${doc} COMPONENT ${component} OPTIONAL)
endforeach()
