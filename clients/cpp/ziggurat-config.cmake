# SPDX-License-Identifier: MIT
# find_package(ziggurat) -> ziggurat::client, the shared library, and ziggurat::client_static, which takes what it uses along.
include(CMakeFindDependencyMacro)
find_dependency(Protobuf)
find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::zmq)
  pkg_check_modules(zmq REQUIRED IMPORTED_TARGET GLOBAL libzmq)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/targets.cmake)
