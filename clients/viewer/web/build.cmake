# SPDX-License-Identifier: Apache-2.0
# cmake -DNPM=npm -DWEB=folder -DCORE=folder -P build.cmake: npm ci, when the lock file is newer than what is installed, and
# vite build, which takes core as WebAssembly from its folder; empty: a page without core.
set(installed ${WEB}/node_modules/.package-lock.json)
if(NOT EXISTS ${installed} OR ${WEB}/package-lock.json IS_NEWER_THAN ${installed})
  execute_process(COMMAND ${NPM} ci --no-audit --no-fund --fetch-retries=1 WORKING_DIRECTORY ${WEB}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    string(REGEX REPLACE "\n+$" "" output "${output}")
    message("${output}")
    message(WARNING "palpate-viewer's page is not built: npm could not fetch what clients/viewer/web/package-lock.json "
      "names (is there a network?). palpate-viewer itself is; build again later for the page.")
    return()
  endif()
  file(TOUCH ${installed})
endif()
set(ENV{PALPATE_CORE} ${CORE})
execute_process(COMMAND ${NPM} run --silent build WORKING_DIRECTORY ${WEB} RESULT_VARIABLE result
  OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "palpate-viewer's page does not build:\n${output}")
endif()
