# SPDX-License-Identifier: Apache-2.0
# check_kernels(TARGET FILES … INCLUDED … DEFINES …): where clang exists, each kernel file is syntax-checked
# during the build, so that a typo is found without a device. Files in lib/ and shared/ are checked through
# their includers.

find_program(NEARLIGHT_CLANG NAMES clang clang-14 clang-15 clang-16 clang-17 clang-18 clang-19)

function(check_kernels target)
  cmake_parse_arguments(ARG "" "" "FILES;INCLUDED;DEFINES" ${ARGN})
  if(NOT NEARLIGHT_CLANG)
    message(STATUS "clang not found: kernels are not syntax-checked at build time")
    return()
  endif()
  set(stamps "")
  list(TRANSFORM ARG_DEFINES PREPEND "-D")
  foreach(file IN LISTS ARG_FILES)
    string(MAKE_C_IDENTIFIER "${file}" symbol)
    set(stamp "${CMAKE_CURRENT_BINARY_DIR}/checked/${symbol}.stamp")
    add_custom_command(OUTPUT "${stamp}"
      COMMAND "${NEARLIGHT_CLANG}" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only
              -Wall -Wextra -Wno-unused-function -Werror ${ARG_DEFINES} -I "${CMAKE_CURRENT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/${file}"
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${CMAKE_CURRENT_BINARY_DIR}/checked"
      COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
      DEPENDS "${file}" ${ARG_INCLUDED}
      COMMENT "Checking kernels/${file}" VERBATIM)
    list(APPEND stamps "${stamp}")
  endforeach()
  add_custom_target(${target} ALL DEPENDS ${stamps})
endfunction()
