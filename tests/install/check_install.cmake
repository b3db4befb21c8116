# SPDX-License-Identifier: Apache-2.0
# Installs nearlight, builds the examples outside of its tree, and compares what they print with closed forms and with
# the program. Needs BINARY_DIR (of nearlight, built), SOURCE_DIR (its root), WORK_DIR, GENERATOR, CXX_COMPILER,
# PKG_CONFIG, NM and LIB_DIR (relative to the prefix).
file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
set(floor "${SOURCE_DIR}/tests/install/floor.xml")
set(cornell_box "${SOURCE_DIR}/scenes/cornell-box/scene.xml")

# run([INPUT FILE] [FAILS] COMMAND…): sets `output` to what it prints.
function(run)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "FAILS" "INPUT" "")
  set(input "")
  if(ARG_INPUT)
    set(input INPUT_FILE "${ARG_INPUT}")
  endif()
  execute_process(COMMAND ${ARG_UNPARSED_ARGUMENTS} ${input}
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if((result EQUAL 0 AND ARG_FAILS) OR (NOT result EQUAL 0 AND NOT ARG_FAILS))
    message(FATAL_ERROR "${ARG_UNPARSED_ARGUMENTS}\nended with ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# Fails unless `text` holds as many numbers as are expected, each within `tolerance` percent of its expected value. CMake
# calculates with whole numbers only, so expected values are given in millionths.
function(expect_numbers text tolerance)
  string(REGEX MATCHALL "[^ \n]+" numbers "${text}")
  list(LENGTH numbers count)
  list(LENGTH ARGN expected_count)
  if(NOT count EQUAL expected_count)
    message(FATAL_ERROR "there should be ${expected_count} numbers in: ${text}")
  endif()
  foreach(number expected IN ZIP_LISTS numbers ARGN)
    math(EXPR low "${expected} * (100 - ${tolerance}) / 100")
    math(EXPR high "${expected} * (100 + ${tolerance}) / 100")
    if(NOT ("${number}e6" GREATER "${low}" AND "${number}e6" LESS "${high}"))
      message(FATAL_ERROR "${number} should be ${expected}e-6 within ${tolerance} %, in: ${text}")
    endif()
  endforeach()
endfunction()

function(expect_text text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "'${pattern}' is not in: ${text}")
  endif()
endfunction()

# What is installed: the face, and nothing that is behind it.
foreach(component Library Development Runtime)
  run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${prefix}" --component ${component})
endforeach()
file(GLOB_RECURSE headers RELATIVE "${prefix}/include" "${prefix}/include/*")
file(GLOB expected_headers RELATIVE "${SOURCE_DIR}/include" "${SOURCE_DIR}/include/nearlight/*.h")
if(NOT headers STREQUAL expected_headers)
  message(FATAL_ERROR "installed headers: ${headers}")
endif()
foreach(header IN LISTS headers)
  file(STRINGS "${prefix}/include/${header}" foreign REGEX "#include.*(CL/|embree|json|spdlog|host/|kernels/)")
  if(foreign)
    message(FATAL_ERROR "${header}: ${foreign}")
  endif()
endforeach()
run("${NM}" --dynamic --defined-only --demangle "${prefix}/${LIB_DIR}/libnearlight.so")
expect_text("${output}" "nearlight::Session::Session")
if(output MATCHES "nearlight::core::[^\n]*")
  message(FATAL_ERROR "the library shows ${CMAKE_MATCH_0}")
endif()

# What belongs to the program: pages and completions.
foreach(file share/man/man1/nearlight-render.1 share/bash-completion/completions/nearlight
    share/zsh/vendor-completions/_nearlight share/fish/vendor_completions.d/nearlight.fish)
  file(STRINGS "${prefix}/${file}" options REGEX "clamp")
  if(NOT options)
    message(FATAL_ERROR "${file} does not name --clamp-radius")
  endif()
endforeach()

# By the CMake package.
foreach(project examples tests/install/outside)
  cmake_path(GET project FILENAME name)
  run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/${project}" -B "${WORK_DIR}/${name}" -G "${GENERATOR}"
      "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}")
  run("${CMAKE_COMMAND}" --build "${WORK_DIR}/${name}")
endforeach()

# The program makes the same picture of the same settings, bit for bit. Its files also say how they were made.
function(expect_same_picture a b)
  run("${prefix}/bin/nearlight" diff "${a}" "${b}" --json)
  expect_text("${output}" "\"rmse\": 0\\.0,")
endfunction()
run("${WORK_DIR}/examples/render_to_png" "${cornell_box}" "${WORK_DIR}/library.png")
expect_text("${output}" "^256x256 pixels of cornell-box by [0-9]+ VPLs on .+\n$")
run("${prefix}/bin/nearlight" render "${cornell_box}" -o "${WORK_DIR}/program.png"
    --size 256x256 --vpls 500 --exposure 0.5)
expect_same_picture("${WORK_DIR}/library.png" "${WORK_DIR}/program.png")
run("${WORK_DIR}/outside/outside" "${cornell_box}" "${WORK_DIR}/outside.png")
run("${prefix}/bin/nearlight" render "${cornell_box}" -o "${WORK_DIR}/small.png" --size 64x64 --vpls 200)
expect_same_picture("${WORK_DIR}/outside.png" "${WORK_DIR}/small.png")

# Under the light: I/d² = 1. Aside: I·cosθ/d² = 0.8/1.25². Just above the floor, looking down: its radiosity, 1/2.
file(WRITE "${WORK_DIR}/points.txt" "0 0 0  0 0 1\n0.75 0 0  0 0 1\n0 0 0.01  0 0 -1\n")
run("${WORK_DIR}/examples/irradiance_at_points" "${floor}" INPUT "${WORK_DIR}/points.txt")
expect_numbers("${output}" 2 1000000 2000000 3000000  512000 1024000 1536000  500000 1000000 1500000)

# The floor reflects half of what the light sends into its solid angle, 4·atan(1/√3) = 2π/3.
run("${WORK_DIR}/examples/vpls_to_file" "${floor}" "${WORK_DIR}/vpls.csv")
string(REGEX MATCH "^([0-9]+) VPLs, [0-9]+ of them within [0-9.]+ m of the camera\n(.*) W\n$" matched "${output}")
expect_numbers("${CMAKE_MATCH_2}" 2 1047198 2094395 3141593)
file(STRINGS "${WORK_DIR}/vpls.csv" lines)
list(LENGTH lines line_count)
math(EXPR expected_lines "${CMAKE_MATCH_1} + 1")
if(NOT line_count EQUAL expected_lines)
  message(FATAL_ERROR "${line_count} lines for: ${output}")
endif()

# By pkg-config.
set(ENV{PKG_CONFIG_PATH} "${prefix}/${LIB_DIR}/pkgconfig")
run("${PKG_CONFIG}" --cflags --libs nearlight)
separate_arguments(flags UNIX_COMMAND "${output}")
run("${CXX_COMPILER}" -std=c++20 "${SOURCE_DIR}/examples/vpls_to_file.cpp" -o "${WORK_DIR}/by_pkg_config" ${flags}
    "-Wl,-rpath,${prefix}/${LIB_DIR}")
run("${WORK_DIR}/by_pkg_config" "${floor}" "${WORK_DIR}/vpls_again.csv")
run("${CMAKE_COMMAND}" -E compare_files "${WORK_DIR}/vpls.csv" "${WORK_DIR}/vpls_again.csv")

# Without the image module a texture is an error, and no grey.
set(TEXTURE "${WORK_DIR}/library.png")
configure_file("${SOURCE_DIR}/tests/install/textured.xml.in" "${WORK_DIR}/textured.xml" @ONLY)
run("${WORK_DIR}/examples/vpls_to_file" "${WORK_DIR}/textured.xml" "${WORK_DIR}/textured.csv")
file(REMOVE "${prefix}/${LIB_DIR}/nearlight/nearlight-images.so")
run("${WORK_DIR}/examples/vpls_to_file" "${WORK_DIR}/textured.xml" "${WORK_DIR}/textured.csv" FAILS)
expect_text("${output}" "^error: cannot load nearlight-images.so")
run("${prefix}/bin/nearlight" info "${WORK_DIR}/textured.xml" FAILS)
expect_text("${output}" "error: cannot load nearlight-images.so")
