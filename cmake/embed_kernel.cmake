# SPDX-License-Identifier: Apache-2.0
# In script mode this writes INPUT as the string constant SYMBOL to OUTPUT. Every byte is escaped, and the constant is
# in pieces that the compiler joins, so that every content and every length compiles.
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
