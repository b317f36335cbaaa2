# SPDX-License-Identifier: Apache-2.0
# What a build reads once instead of once a file (docs/decisions/build_time.md).

# Sources of a target are compiled eight at a time, so they share what they include, and names in their unnamed namespaces have to
# differ. SKIP_UNITY_BUILD_INCLUSION excepts one; -DCMAKE_UNITY_BUILD=OFF compiles each by itself.
option(CMAKE_UNITY_BUILD "Compile sources of a target eight at a time" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
# Such a unit names its sources by their folder. __FILE__ leaves it out, so that ccache finds what it compiled in another clone.
add_compile_options(-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
# gcc takes a source that another includes for a header, whose classes should hold nothing of an unnamed namespace.
target_compile_options(palpate_options INTERFACE
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<COMPILE_LANG_AND_ID:CXX,GNU>>:-Wno-subobject-linkage>)

# Headers that most sources include. Sources name what they use all the same; -DPALPATE_PRECOMPILE=OFF -DCMAKE_UNITY_BUILD=OFF
# shows those that do not.
# Off for clang with ccache, which finds nothing of another build folder again once clang's headers are precompiled.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(palpate_precompile_default OFF)
else()
  set(palpate_precompile_default ON)
endif()
option(PALPATE_PRECOMPILE "Precompile the headers that sources share" ${palpate_precompile_default})
set(PALPATE_STANDARD_HEADERS <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory>
  <optional> <span> <sstream> <string> <thread> <vector>)

# What comes from a precompiled header is no system header to gcc 12, which then finds copies inside std::string out of bounds.
set(PALPATE_PRECOMPILED_OPTIONS "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow>")

if(PALPATE_PRECOMPILE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)  # what ccache asks for
  endif()
  find_package(Eigen3 REQUIRED NO_MODULE)
  add_library(palpate_headers STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
  target_link_libraries(palpate_headers PRIVATE palpate_options Eigen3::Eigen)
  target_precompile_headers(palpate_headers PRIVATE <Eigen/Core> <Eigen/Geometry> ${PALPATE_STANDARD_HEADERS})
endif()

# palpate_precompiled(library...): static libraries whose sources mostly include Eigen or the standard library. Not under
# gcc's sanitizers: those builds keep the warnings.
function(palpate_precompiled)
  if(PALPATE_PRECOMPILE AND (NOT PALPATE_SANITIZE OR CMAKE_CXX_COMPILER_ID STREQUAL "Clang"))
    foreach(library IN LISTS ARGN)
      target_precompile_headers(${library} REUSE_FROM palpate_headers)
      target_compile_options(${library} PRIVATE ${PALPATE_PRECOMPILED_OPTIONS})
    endforeach()
  endif()
endfunction()
