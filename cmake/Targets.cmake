# SPDX-License-Identifier: Apache-2.0
# What all targets of nearlight share: warnings, sanitizers and the include root.

add_library(nearlight_options INTERFACE)
target_compile_options(nearlight_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${NEARLIGHT_WERROR}>>:-Werror>
  # Host arithmetic must not depend on whether the compiler fused a multiply and an add.
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
if(NEARLIGHT_SANITIZE)
  target_compile_options(nearlight_options INTERFACE -fsanitize=${NEARLIGHT_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # The sanitizer replaces dlopen(), and its version searches the program's run path only if that is a DT_RPATH.
  target_link_options(nearlight_options INTERFACE -fsanitize=${NEARLIGHT_SANITIZE} -Wl,--disable-new-dtags)
endif()

# The sanitizer's runtime wants to be loaded first, before a library that stands before OpenCL's. Clang's runtime is part of
# the programs and cannot be loaded so.
set(NEARLIGHT_CAN_PRELOAD ON)
set(NEARLIGHT_SANITIZER_RUNTIME "")
if(NEARLIGHT_SANITIZE MATCHES "(address|thread)")
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    string(SUBSTRING "${CMAKE_MATCH_1}" 0 1 initial)
    execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -print-file-name=lib${initial}san.so
      OUTPUT_VARIABLE NEARLIGHT_SANITIZER_RUNTIME OUTPUT_STRIP_TRAILING_WHITESPACE)
  else()
    set(NEARLIGHT_CAN_PRELOAD OFF)
  endif()
endif()

# Programs load their modules when they need them, and find them by their run path.
set(NEARLIGHT_MODULE_DIR "${PROJECT_BINARY_DIR}/modules")
set(CMAKE_BUILD_RPATH "${NEARLIGHT_MODULE_DIR}")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/nearlight")

# Most of the time of a build goes into headers (opencl.hpp, CLI11, json.hpp, gtest.h). Several sources in one
# compilation read them and instantiate their templates only once.
function(nearlight_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${NEARLIGHT_UNITY} UNITY_BUILD_BATCH_SIZE 32)
endfunction()

# The shared library (host/library) contains rooms, and exports none of their symbols.
function(nearlight_for_shared_library target)
  set_target_properties(${target} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# This is for code that runs once and for a short time.
set(NEARLIGHT_COLD_OPTIONS $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)

# nearlight_library(NAME [COLD] SOURCES … PUBLIC … PRIVATE …): a static library of one room of host/. COLD: its speed
# does not matter, so it is compiled quickly.
function(nearlight_library name)
  cmake_parse_arguments(ARG "COLD" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  nearlight_compile_together(${name})
  nearlight_for_shared_library(${name})
  if(ARG_COLD)
    target_compile_options(${name} PRIVATE ${NEARLIGHT_COLD_OPTIONS})
  endif()
  add_library(nearlight::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/include"
    "${PROJECT_SOURCE_DIR}/kernels")
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE nearlight_options ${ARG_PRIVATE})
  if(NEARLIGHT_CLANG_TIDY)
    set_target_properties(${name} PROPERTIES CXX_CLANG_TIDY clang-tidy)
  endif()
endfunction()

# nearlight_module(NAME ROOM … SOURCES … PRIVATE …): the module nearlight-NAME, which the room loads when it first needs
# it, from the run path of the program or of the shared library.
function(nearlight_module name)
  cmake_parse_arguments(ARG "" "ROOM" "SOURCES;PRIVATE" ${ARGN})
  set(target nearlight_${name})
  add_library(${target} MODULE ${ARG_SOURCES})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/include"
    "${PROJECT_SOURCE_DIR}/kernels")
  target_link_libraries(${target} PRIVATE nearlight_options ${ARG_PRIVATE})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME nearlight-${name}
    LIBRARY_OUTPUT_DIRECTORY "${NEARLIGHT_MODULE_DIR}")
  add_dependencies(${ARG_ROOM} ${target})
endfunction()

# nearlight_test(NAME [ALONE] SOURCES … LIBRARIES … LABELS … TIMEOUT … ENVIRONMENT VARIABLE=value …): one GoogleTest
# binary, of which each case is a test of ctest. With ALONE no other test runs beside them.
function(nearlight_test name)
  cmake_parse_arguments(ARG "ALONE" "TIMEOUT" "SOURCES;LIBRARIES;LABELS;ENVIRONMENT" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set(environment "")
  if(ARG_ENVIRONMENT)
    set(environment ENVIRONMENT "${ARG_ENVIRONMENT}")
  endif()
  set(alone "")
  if(ARG_ALONE)
    set(alone RUN_SERIAL TRUE)
  endif()
  string(REGEX MATCH "address|thread" reserves_addresses "${NEARLIGHT_SANITIZE}")
  add_executable(${name} ${ARG_SOURCES})
  nearlight_compile_together(${name})
  target_compile_options(${name} PRIVATE ${NEARLIGHT_COLD_OPTIONS})
  target_link_libraries(${name} PRIVATE nearlight_options GTest::gtest_main ${ARG_LIBRARIES})
  target_compile_definitions(${name} PRIVATE
    NEARLIGHT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" NEARLIGHT_BINARY_DIR="${PROJECT_BINARY_DIR}"
    # These sanitizers reserve terabytes of addresses, so that tests cannot limit them.
    $<$<NOT:$<STREQUAL:"${reserves_addresses}","">>:NEARLIGHT_RESERVES_ADDRESSES>)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_PREFIX "${name}." NO_PRETTY_VALUES
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} ${environment} ${alone})
endfunction()
