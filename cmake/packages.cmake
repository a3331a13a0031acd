# SPDX-License-Identifier: MIT
# Everything comes from Debian 12 packages; docs/packages.md names each with its reason.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(pugixml REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Protobuf REQUIRED)
find_package(Boost 1.74 REQUIRED COMPONENTS program_options)
# Of Bullet two libraries: its pkg-config file names its dynamics, too. In double precision; its
# headers must see the same setting as its libraries.
pkg_check_modules(bullet REQUIRED bullet-float64)
find_library(bullet_collision_library BulletCollision-float64 HINTS ${bullet_LIBRARY_DIRS} REQUIRED)
find_library(bullet_math_library LinearMath-float64 HINTS ${bullet_LIBRARY_DIRS} REQUIRED)
add_library(bullet_collision INTERFACE)
target_compile_options(bullet_collision INTERFACE ${bullet_CFLAGS_OTHER})
target_include_directories(bullet_collision SYSTEM INTERFACE ${bullet_INCLUDE_DIRS})
target_link_libraries(bullet_collision INTERFACE ${bullet_collision_library} ${bullet_math_library})
pkg_check_modules(qhull REQUIRED IMPORTED_TARGET GLOBAL qhull_r)
pkg_check_modules(zmq REQUIRED IMPORTED_TARGET GLOBAL libzmq)
pkg_check_modules(sodium REQUIRED IMPORTED_TARGET GLOBAL libsodium)
if(ZIGGURAT_TESTS)
  pkg_check_modules(httplib REQUIRED IMPORTED_TARGET GLOBAL cpp-httplib)
endif()
pkg_check_modules(sqlite REQUIRED IMPORTED_TARGET GLOBAL sqlite3)
find_path(tomlplusplus_include toml++/toml.h REQUIRED)  # headers and no more
pkg_check_modules(lua REQUIRED IMPORTED_TARGET GLOBAL lua5.3)
pkg_check_modules(png REQUIRED IMPORTED_TARGET GLOBAL libpng)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET GLOBAL libzstd)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET GLOBAL liblz4)
find_package(ZLIB REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET GLOBAL libxxhash)
find_path(tinyobjloader_include tiny_obj_loader.h REQUIRED)  # a header and no more
set(ZIGGURAT_PYTHON /usr/bin/python3 CACHE FILEPATH
    "the Python that Debian's python3-zmq and python3-protobuf belong to")
