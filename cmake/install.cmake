# SPDX-License-Identifier: Apache-2.0
# `cmake --install` installs two components: the library for drivers (component haptic) and the programs (component
# programs).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS palpate_haptic EXPORT palpateTargets COMPONENT haptic
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT haptic NAMELINK_COMPONENT haptic
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

# The description of the wire, for clients in other languages, and the driver template.
install(FILES idl/palpate.idl DESTINATION ${PALPATE_DATA_DIR} COMPONENT haptic)
install(FILES clients/driver_template/driver.cpp clients/driver_template/README.md
  DESTINATION ${PALPATE_DATA_DIR}/driver_template COMPONENT haptic)

install(FILES clients/examples/CMakeLists.txt clients/examples/README.md clients/examples/touch.c clients/examples/touch.py
  clients/examples/palpate_qos.xml DESTINATION ${PALPATE_DATA_DIR}/examples COMPONENT haptic)

set(PALPATE_PROGRAMS palpate-server palpate-tool palpate-latency palpate-watch palpate-device palpate-parameters
  palpate-viewer
  palpate-organ palpate-solve palpate-inspect palpate-query palpate-reproduce palpate-replay)
foreach(program IN LISTS PALPATE_PROGRAMS)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  endif()
endforeach()
# The page, if it was built (clients/viewer/web).
install(DIRECTORY clients/viewer/web/dist/ DESTINATION ${PALPATE_DATA_DIR}/viewer COMPONENT programs OPTIONAL)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
configure_file(server/palpate-server.service.in ${CMAKE_CURRENT_BINARY_DIR}/palpate-server.service @ONLY)
install(FILES server/server.toml server/palpate-limits.conf server/palpate-cpu-latency.rules
  ${CMAKE_CURRENT_BINARY_DIR}/palpate-server.service DESTINATION ${PALPATE_DATA_DIR} COMPONENT programs)
