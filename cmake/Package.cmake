# SPDX-License-Identifier: Apache-2.0
# Debian packages, by `cpack` in the build folder: nearlight (the program), libnearlight (the shared library, and the
# modules that it and the program load), libnearlight-dev (headers) and, where they are built, nearlight-viewer (the module
# of `nearlight view`, which needs a desktop's libraries) and nearlight-mpi (the module that calls MPI).
set(suggested "")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME nearlight)
set(CPACK_PACKAGE_VENDOR nearlight)
set(CPACK_PACKAGE_CONTACT "The nearlight authors <nearlight@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL Runtime Library Development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(version "${PROJECT_VERSION}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME nearlight)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
# Without a driver the program can do little more than say so.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libnearlight (= ${version})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Renderer of global illumination with virtual point lights
 on any OpenCL device, with its path-traced reference and its test bench.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libnearlight)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Shared library of nearlight
 A scene on OpenCL devices: pictures, virtual point lights and irradiance.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libnearlight-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libnearlight (= ${version})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers of libnearlight
 The headers, the CMake package and the pkg-config file.")

if(TARGET nearlight_mpi)
  list(APPEND CPACK_COMPONENTS_ALL Mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME nearlight-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "nearlight (= ${version})")
  set(CPACK_COMPONENT_MPI_DESCRIPTION "Pictures by many machines
 A module of the program with which `mpirun nearlight render` makes one picture.")
  list(APPEND suggested nearlight-mpi)
endif()
if(NEARLIGHT_VIEWER)
  list(APPEND CPACK_COMPONENTS_ALL Viewer)
  set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME nearlight-viewer)
  set(CPACK_DEBIAN_VIEWER_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_VIEWER_PACKAGE_DEPENDS "nearlight (= ${version}), libnearlight (= ${version})")
  # The viewer links to the library, which no package has yet when dependencies are looked up.
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/host/library")
  set(CPACK_COMPONENT_VIEWER_DESCRIPTION "Window of nearlight
 A module of the program with which one walks about in a scene while it is rendered.")
  list(APPEND suggested nearlight-viewer)
endif()
list(JOIN suggested ", " CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS)
include(CPack)
