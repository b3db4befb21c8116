# SPDX-License-Identifier: Apache-2.0
# Needs BINARY_DIR (of nearlight, built), SOURCE_DIR, WORK_DIR, GENERATOR, CXX_COMPILER.
file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${prefix}" --component Development)
run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/consumer" -B "${WORK_DIR}/build" -G "${GENERATOR}"
    "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")

file(WRITE "${WORK_DIR}/picture.ppm" "P3 3 2 255  0 0 0  0 0 0  0 0 0   0 0 0  0 0 0  255 0 51\n")
run("${WORK_DIR}/build/consumer" "${WORK_DIR}/picture.ppm")
if(NOT output STREQUAL "3x2 0.2\n")
  message(FATAL_ERROR "the consumer read: ${output}")
endif()
