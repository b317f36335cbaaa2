# SPDX-License-Identifier: Apache-2.0
# palpate.idl lists the status flags and the live parameters. What C++, C and the page need of them is made from it when
# CMake configures.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(PALPATE_LISTS_DIR ${CMAKE_BINARY_DIR}/lists)  # core's and idl's include path beside their own
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_LIST_DIR}/palpate.idl ${CMAKE_CURRENT_LIST_DIR}/make_lists.py)
execute_process(
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/make_lists.py ${CMAKE_CURRENT_LIST_DIR}/palpate.idl
    ${PALPATE_LISTS_DIR} ${PROJECT_SOURCE_DIR}/clients/viewer/web/src/flag_list.ts
  COMMAND_ERROR_IS_FATAL ANY)
