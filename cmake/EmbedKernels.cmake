# SPDX-License-Identifier: Apache-2.0
# embed_kernels(TARGET FILES …): puts each kernel source, byte for byte, into a generated C++ file, and makes a
# registry of them all. Editing a kernel rebuilds only its own file.

function(embed_kernels target)
  cmake_parse_arguments(ARG "" "" "FILES" ${ARGN})
  set(generated_dir "${CMAKE_CURRENT_BINARY_DIR}/embedded")
  set(sources "")
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS ARG_FILES)
    string(MAKE_C_IDENTIFIER "${file}" symbol)
    set(output "${generated_dir}/${symbol}.cpp")
    add_custom_command(OUTPUT "${output}"
      COMMAND "${CMAKE_COMMAND}" -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/${file} -DOUTPUT=${output} -DSYMBOL=${symbol}
              -P "${PROJECT_SOURCE_DIR}/cmake/embed_kernel.cmake"
      DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${file}" "${PROJECT_SOURCE_DIR}/cmake/embed_kernel.cmake"
      COMMENT "Embedding kernels/${file}" VERBATIM)
    list(APPEND sources "${output}")
    string(APPEND declarations "extern const std::string_view ${symbol};\n")
    string(APPEND entries "    {\"${file}\", &embedded::${symbol}},\n")
  endforeach()
  set(EMBEDDED_DECLARATIONS "${declarations}")
  set(EMBEDDED_ENTRIES "${entries}")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/embedded_kernels.cpp.in" "${generated_dir}/registry.cpp" @ONLY)
  add_library(${target} STATIC ${sources} "${generated_dir}/registry.cpp")
  nearlight_for_shared_library(${target})
  target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/include"
    "${PROJECT_SOURCE_DIR}/kernels")
endfunction()
