# SPDX-License-Identifier: MIT
# Debian packages by CPack: ziggurat, libziggurat0, libziggurat-dev, python3-ziggurat. The preset `package` has the layout
# of Debian's /usr; tools/packaging/debian/build makes all of it.
set(ZIGGURAT_MAINTAINER "The Ziggurat authors <ziggurat@example.org>" CACHE STRING "who makes the packages")
set(ZIGGURAT_DEBIAN_REVISION 1 CACHE STRING "of the packages, behind the version")

set(names ziggurat libziggurat0 libziggurat-dev python3-ziggurat)
set(components programs library development python)
set(made ${CMAKE_CURRENT_BINARY_DIR}/debian)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, if it is set
configure_file(debian/changelog.in ${made}/changelog.Debian @ONLY)
execute_process(COMMAND gzip -9nf ${made}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(name component IN ZIP_LISTS names components)
  install(FILES debian/copyright ${made}/changelog.Debian.gz DESTINATION share/doc/${name} COMPONENT ${component})
endforeach()
install(FILES debian/lintian-overrides DESTINATION share/lintian/overrides RENAME ziggurat COMPONENT programs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ziggurat)
set(CPACK_PACKAGE_CONTACT ${ZIGGURAT_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${ZIGGURAT_DEBIAN_REVISION})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(full ${PROJECT_VERSION}-${ZIGGURAT_DEBIAN_REVISION})

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME ziggurat)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "python3-ziggurat, libziggurat-dev, ffmpeg")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "simulation of robots in lock-step with their controllers
Ziggurat runs scenes of robots: bodies in contact, joints, magnets, radios and
cameras. Controllers are Lua scripts or programs of their own, which connect
over ZeroMQ; the world waits for each of them at every tick, so that equal
seeds give equal runs.

This package has the server, the runner of Lua controllers, a module for
other Lua programs, the page that shows a running world, scenes and examples.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libziggurat0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
    "${CMAKE_CURRENT_SOURCE_DIR}/debian/shlibs;${CMAKE_CURRENT_SOURCE_DIR}/debian/triggers")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "controllers for robots of a Ziggurat server, shared library
Programs in C++ connect with it to a simulation server, read the sensors of
their robots and set their actuators at every tick.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libziggurat-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libziggurat0 (= ${full}), libprotobuf-dev, libzmq3-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake, g++")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "controllers for robots of a Ziggurat server, development files
Headers of the C++ library, its shared and its static form, files for CMake
and pkg-config, and the messages of the protocol for other languages.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-ziggurat)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3:any, python3-protobuf, python3-zmq")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-numpy, ziggurat")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    "${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst;${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "controllers for robots of a Ziggurat server, in Python
Programs in Python connect with it to a simulation server, as controllers,
directors or supervisors, or train policies in many worlds at once.

The conformance kit proves a server or a client of the protocol right.")
include(CPack)
