# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: the program, and the libraries with their headers as package `nearlight`.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/nearlight")

# Those that this build has; the program's own commands (host/cli) are no library for others.
set(installed_libraries "")
foreach(library base kernels image scene bvh cl stages samplers session reference)
  if(TARGET nearlight_${library})
    list(APPEND installed_libraries nearlight_${library})
  endif()
endforeach()

# The packages that those link to, by the first part of names like OpenImageIO::OpenImageIO, become dependencies
# of ours. Embree has a target without such a part.
set(packages "")
foreach(library IN LISTS installed_libraries)
  target_compile_features(${library} PUBLIC cxx_std_20)
  get_target_property(links ${library} INTERFACE_LINK_LIBRARIES)
  string(REGEX MATCHALL "[A-Za-z0-9_]+::" prefixes "${links}")
  list(APPEND packages ${prefixes})
  if(links MATCHES "[:;]embree[;>]|[:;]embree$|^embree$")
    list(APPEND packages "embree ${EMBREE_VERSION_MAJOR}")
  endif()
endforeach()
list(TRANSFORM packages REPLACE "::$" "")
list(REMOVE_ITEM packages nearlight)
list(REMOVE_DUPLICATES packages)
set(NEARLIGHT_DEPENDENCIES "")
foreach(package IN LISTS packages)
  string(APPEND NEARLIGHT_DEPENDENCIES "find_dependency(${package})\n")
endforeach()

install(TARGETS ${installed_libraries} EXPORT nearlight-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT Development)
install(EXPORT nearlight-targets NAMESPACE nearlight:: DESTINATION "${package_dir}" COMPONENT Development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/host" "${PROJECT_SOURCE_DIR}/kernels"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/nearlight" COMPONENT Development
  FILES_MATCHING PATTERN "*.h" PATTERN "host/cli" EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/nearlight" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT Development)

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/nearlight-config.cmake.in"
  "${PROJECT_BINARY_DIR}/nearlight-config.cmake" INSTALL_DESTINATION "${package_dir}")
# Until 1.0, a minor version may change interfaces.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/nearlight-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/nearlight-config.cmake" "${PROJECT_BINARY_DIR}/nearlight-config-version.cmake"
  DESTINATION "${package_dir}" COMPONENT Development)

# Both the program and the libraries load it.
foreach(component Development Runtime)
  install(TARGETS nearlight_images LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/nearlight" COMPONENT ${component})
endforeach()
install(TARGETS nearlight RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT Runtime)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT Runtime)
