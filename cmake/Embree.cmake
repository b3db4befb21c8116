# SPDX-License-Identifier: Apache-2.0
# The target `embree` is version 4, or else version 3. Their headers are in different folders, so a definition tells
# sources which version it is.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
message(STATUS "Embree ${EMBREE_VERSION}")
target_compile_definitions(embree INTERFACE NEARLIGHT_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR})
