# SPDX-License-Identifier: MIT
# Flags that every target shares. Bit-identical results are part of the product:
# no fast-math, no fused multiply-add contraction, the baseline instruction set.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths below the checkout are relative for it: it knows what another clone has compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} ${CCACHE})
endif()

add_compile_options(-ffp-contract=off -fno-fast-math -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
if(ZIGGURAT_UNIT_SIZE)
  add_compile_options(-Wno-shadow)  # of names in another source
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 sees overlaps in std::string::assign(const char*) that are not there (its bug 105651).
  add_compile_options($<$<NOT:$<CONFIG:Debug>>:-Wno-restrict>)
endif()
if(ZIGGURAT_WERROR)
  add_compile_options(-Werror)
endif()
if(ZIGGURAT_SANITIZE)
  add_compile_options(-fsanitize=${ZIGGURAT_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ZIGGURAT_SANITIZE})
  if(ZIGGURAT_NO_SANITIZE)
    add_compile_options(-fno-sanitize=${ZIGGURAT_NO_SANITIZE})
  endif()
endif()
