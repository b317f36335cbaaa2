# SPDX-License-Identifier: Apache-2.0
# Installs the haptic library into a scratch prefix, builds the project beside this file against it, runs what came out.
file(REMOVE_RECURSE ${SCRATCH})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Nobody else's DDS: loopback, without multicast.
set(ENV{CYCLONEDDS_URI} "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/>\
</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>\
<MaxAutoParticipantIndex>30</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>")
set(prefix ${SCRATCH}/prefix)
foreach(component IN ITEMS library haptic)
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component ${component})
endforeach()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/build -G ${GENERATOR}
  -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer_c)
run(${SCRATCH}/build/consumer_cpp)

# The template's README as printed: its CMakeLists.txt, and its line without CMake, beside a copy of driver.cpp.
set(template ${prefix}/share/palpate/driver_template)
set(printed ${SCRATCH}/printed)
file(READ ${template}/README.md text)
foreach(part IN ITEMS cmake sh)
  if(NOT text MATCHES "```${part}\n([^`]*)\n```")
    message(FATAL_ERROR "${template}/README.md has no block of ${part}")
  endif()
  set(${part} "${CMAKE_MATCH_1}\n")
endforeach()
file(COPY ${template}/driver.cpp DESTINATION ${printed})
file(WRITE ${printed}/CMakeLists.txt "${cmake}")
file(WRITE ${printed}/build.sh "cd ${printed}\n${sh}")
run(${CMAKE_COMMAND} -S ${printed} -B ${printed}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${printed}/build)
run(${printed}/build/my-driver --help)

# The driver template is a project of its own, and builds by pkg-config too.
run(${CMAKE_COMMAND} -S ${template} -B ${SCRATCH}/template -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${SCRATCH}/template)
run(${SCRATCH}/template/palpate-driver-template --help)
file(GLOB pc ${prefix}/lib*/pkgconfig ${prefix}/lib/*/pkgconfig)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} pkg-config --cflags --libs palpate-haptic
  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags)
run(${CXX_COMPILER} -std=c++17 ${template}/driver.cpp ${flags} -Wl,-rpath,${pc}/.. -o ${SCRATCH}/by_pkg_config)
run(${SCRATCH}/by_pkg_config --help)
run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} sh -e ${printed}/build.sh)
run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc}/.. ${printed}/my-driver --help)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} pkg-config --modversion palpate-haptic
  OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT version MATCHES "^0[.]1[.]")
  message(FATAL_ERROR "pkg-config says that palpate-haptic is ${version}")
endif()

# A newer palpate than there is must not be found.
file(WRITE ${SCRATCH}/newer/CMakeLists.txt
  "cmake_minimum_required(VERSION 3.25)\nproject(newer LANGUAGES NONE)\nfind_package(palpate 99.0 REQUIRED)\n")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SCRATCH}/newer -B ${SCRATCH}/newer/build -DCMAKE_PREFIX_PATH=${prefix}
  RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE complaint)
if(code EQUAL 0 OR NOT complaint MATCHES "0.1.0")
  message(FATAL_ERROR "palpate 99.0 was found, or not refused for its version: ${complaint}")
endif()
