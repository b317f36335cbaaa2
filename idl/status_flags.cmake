# SPDX-License-Identifier: Apache-2.0
# palpate.idl lists the status flags; the constants of C++, C and the page are made from it when CMake configures.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(PALPATE_FLAGS_DIR ${CMAKE_BINARY_DIR}/status_flags)  # core's and idl's include path beside their own
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_LIST_DIR}/palpate.idl ${CMAKE_CURRENT_LIST_DIR}/status_flags.py)
execute_process(
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/status_flags.py ${CMAKE_CURRENT_LIST_DIR}/palpate.idl
    ${PALPATE_FLAGS_DIR} ${PROJECT_SOURCE_DIR}/clients/viewer/web/src/flag_list.ts
  COMMAND_ERROR_IS_FATAL ANY)
