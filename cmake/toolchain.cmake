# SPDX-License-Identifier: Apache-2.0
# Compiler flags that hold for every target.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Own sources get these through palpate_options; generated code does not.
add_library(palpate_options INTERFACE)
target_compile_options(palpate_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    $<IF:$<CXX_COMPILER_ID:Clang>,-Wcast-align,-Wcast-align=strict> -Wdouble-promotion>)

# Real time stands in the signature (docs/design.md, Threads): a function effect where the compiler has it, else nothing.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 20)
  target_compile_definitions(palpate_options INTERFACE "PALPATE_NONBLOCKING=[[clang::nonblocking]]")
  # Clang's own warnings are not errors, except this one. gcc judges the rest.
  target_compile_options(palpate_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wfunction-effects -Werror=function-effects>)
  # For functions that call code which the compiler cannot see; each use says why the call is safe.
  set(palpate_ignore "_Pragma(\"clang diagnostic ignored \\\"-Wfunction-effects\\\"\")")
  target_compile_definitions(palpate_options INTERFACE
    "PALPATE_TRUSTED_BEGIN=_Pragma(\"clang diagnostic push\") ${palpate_ignore}"
    "PALPATE_TRUSTED_END=_Pragma(\"clang diagnostic pop\")")
else()
  target_compile_options(palpate_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
  target_compile_definitions(palpate_options INTERFACE PALPATE_NONBLOCKING= PALPATE_TRUSTED_BEGIN= PALPATE_TRUSTED_END=)
endif()
target_compile_definitions(palpate_options INTERFACE PALPATE_VERSION="${PROJECT_VERSION}")

if(PALPATE_SANITIZE)
  # Reports need line numbers only; full -g doubles the time to build Eigen's templates under a sanitizer.
  # What UndefinedBehaviorSanitizer finds ends the program, so that a test fails.
  add_compile_options(-fsanitize=${PALPATE_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g1 -O1)
  add_link_options(-fsanitize=${PALPATE_SANITIZE})
else()
  # Kernels marked PALPATE_MULTIVERSION are built for several instruction sets and chosen at load time. This needs
  # resolvers, in which sanitizers cannot run, so sanitizer builds leave it out.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_definitions(palpate_options INTERFACE PALPATE_HAVE_TARGET_CLONES=1)
  endif()
endif()
