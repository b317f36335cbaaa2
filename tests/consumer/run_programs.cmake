# SPDX-License-Identifier: Apache-2.0
# Installs everything and starts each program from where it then is.
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${SCRATCH} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
foreach(name IN ITEMS server tool latency watch device parameters viewer organ solve inspect query reproduce replay)
  execute_process(COMMAND ${SCRATCH}/bin/palpate-${name} --help COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endforeach()
file(REMOVE_RECURSE ${SCRATCH})
