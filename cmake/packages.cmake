# SPDX-License-Identifier: Apache-2.0
# cpack -G DEB makes one Debian package of each component of cmake/install.cmake; tools/package calls it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR palpate)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(PALPATE_MAINTAINER "palpate maintainers <maintainers@palpate.invalid>" CACHE STRING "Name and address in Debian packages")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${PALPATE_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX ${PALPATE_PACKAGED_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs solver library haptic)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(same_version "(= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME ${PALPATE_PACKAGE_programs})
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS adduser)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "palpate-solver ${same_version}")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA
  ${PROJECT_SOURCE_DIR}/tools/packaging/palpate/conffiles ${PROJECT_SOURCE_DIR}/tools/packaging/palpate/postinst
  ${PROJECT_SOURCE_DIR}/tools/packaging/palpate/postrm ${PROJECT_SOURCE_DIR}/tools/packaging/palpate/prerm)
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "soft organs for haptic devices, in real time
A server answers the poses of haptic devices at 1 kHz with the forces of a
soft organ in large deformation, over DDS. The organ's answers come from a
model file, which palpate-solve computes beforehand.

This package holds the server with a systemd unit, the page that shows the
organ in a browser, and the programs that play, measure, inspect and find an
organ's stiffness from measurements.")

set(CPACK_DEBIAN_SOLVER_PACKAGE_NAME ${PALPATE_PACKAGE_solver})
set(CPACK_DEBIAN_SOLVER_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SOLVER_PACKAGE_DEPENDS "palpate ${same_version}")  # palpate-read-model
set(CPACK_DEBIAN_SOLVER_PACKAGE_SUGGESTS "calculix-ccx, gnuplot-nox | gnuplot, openmpi-bin")
set(CPACK_COMPONENT_SOLVER_DESCRIPTION "makes organs and their models for palpate-server
palpate-organ makes and imports tetrahedral meshes of organs, palpate-solve
computes their models, palpate-query checks single touches against a full
nonlinear solution, palpate-certify states a model's errors in its file, and
palpate-reproduce repeats the benchmarks of the paper that the method comes
from.

These programs link Gmsh, CGAL and SuiteSparse, so they are distributed under the
GPL.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${PALPATE_PACKAGE_library})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/tools/packaging/library/triggers)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "library for drivers of haptic devices that feel palpate's organs
It sends a device's poses to palpate-server over DDS, and gives the force as
of now: extrapolated between answers, and zero when answers stay away.")

set(CPACK_DEBIAN_HAPTIC_PACKAGE_NAME ${PALPATE_PACKAGE_haptic})
set(CPACK_DEBIAN_HAPTIC_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_HAPTIC_PACKAGE_DEPENDS "${PALPATE_PACKAGE_library} ${same_version}")
set(CPACK_DEBIAN_HAPTIC_PACKAGE_SUGGESTS "cmake, pkg-config, palpate, cyclonedds-dev")
set(CPACK_COMPONENT_HAPTIC_DESCRIPTION "headers and a template for drivers of haptic devices
Headers for C and C++, the CMake package palpate, the pkg-config file
palpate-haptic, a driver in one file to begin with, and the description of
the wire with examples that use nothing else.")
include(CPack)
