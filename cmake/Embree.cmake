# SPDX-License-Identifier: Apache-2.0
# Target `embree`, version 4 or else 3. Their headers lie in different folders, so sources are told which one it is.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
message(STATUS "Embree ${EMBREE_VERSION}")
target_compile_definitions(embree INTERFACE NEARLIGHT_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR})
