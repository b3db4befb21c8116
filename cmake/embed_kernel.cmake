# SPDX-License-Identifier: Apache-2.0
# Script mode: writes INPUT as a string constant SYMBOL to OUTPUT, every byte escaped and in pieces that the
# compiler joins, so that no byte and no length can upset it.
file(READ "${INPUT}" text HEX)
string(LENGTH "${text}" hex_length)
set(body "")
set(at 0)
while(at LESS hex_length)
  string(SUBSTRING "${text}" ${at} 4096 piece)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" escaped "${piece}")
  string(APPEND body "    \"${escaped}\"\n")
  math(EXPR at "${at} + 4096")
endwhile()
if(body STREQUAL "")
  set(body "    \"\"\n")
endif()
math(EXPR byte_count "${hex_length} / 2")
file(WRITE "${OUTPUT}" "// Made from ${INPUT} by cmake/embed_kernel.cmake.
#include <string_view>
namespace nearlight::core::embedded {
extern const std::string_view ${SYMBOL};
const std::string_view ${SYMBOL}{
${body}    , ${byte_count}};
}  // namespace nearlight::core::embedded
")
