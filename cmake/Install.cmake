# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs. The component Library is the shared library, and the modules that both it and the
# program load: images, and Draco where it is found. Development is the library's headers, CMake package and pkg-config
# file. Runtime is the program, which needs the modules only.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/nearlight")

install(TARGETS nearlight_library EXPORT nearlight-targets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT Library NAMELINK_COMPONENT Development)
install(TARGETS ${NEARLIGHT_MODULES} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/nearlight" COMPONENT Library)
install(EXPORT nearlight-targets NAMESPACE nearlight:: DESTINATION "${package_dir}" COMPONENT Development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/nearlight" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT Development FILES_MATCHING PATTERN "*.h")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/nearlight-config.cmake.in"
  "${PROJECT_BINARY_DIR}/nearlight-config.cmake" INSTALL_DESTINATION "${package_dir}")
# Until 1.0, a minor version may change interfaces.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/nearlight-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/nearlight-config.cmake" "${PROJECT_BINARY_DIR}/nearlight-config-version.cmake"
  DESTINATION "${package_dir}" COMPONENT Development)

# pkg-config derives the prefix from the place of its file, so that an installed copy can be moved.
file(RELATIVE_PATH NEARLIGHT_PC_TO_PREFIX "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
configure_file("${PROJECT_SOURCE_DIR}/cmake/nearlight.pc.in" "${PROJECT_BINARY_DIR}/nearlight.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/nearlight.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
  COMPONENT Development)

# The viewer's module is loaded by the program, and uses the library.
if(NEARLIGHT_VIEWER)
  install(TARGETS nearlight_viewer LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/nearlight" COMPONENT Viewer)
endif()
# Processes that mpirun started load the module that calls MPI.
if(TARGET nearlight_mpi)
  install(TARGETS nearlight_mpi LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/nearlight" COMPONENT Mpi)
endif()
install(TARGETS nearlight RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT Runtime)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT Runtime)

if(NOT CMAKE_CROSSCOMPILING)
  install(DIRECTORY "${NEARLIGHT_DOCUMENT_DIR}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT Runtime)
  install(FILES "${NEARLIGHT_DOCUMENT_DIR}/nearlight.bash" RENAME nearlight
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT Runtime)
  install(FILES "${NEARLIGHT_DOCUMENT_DIR}/_nearlight"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" COMPONENT Runtime)
  install(FILES "${NEARLIGHT_DOCUMENT_DIR}/nearlight.fish"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT Runtime)
endif()

include(Package)
