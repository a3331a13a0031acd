# SPDX-License-Identifier: MIT
# Installs everything into a fresh prefix, of which nothing may be elsewhere, and uses it: the project
# beside this file, built by find_package and again by pkg-config, the programs, the Python client.
# Compiler and generator are those of BUILD: no other need be there.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGV}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --config "${CONFIG}")
file(STRINGS ${BUILD}/install_manifest.txt installed)
foreach(file ${installed})
  cmake_path(IS_PREFIX prefix ${file} NORMALIZE is_below)
  if(NOT is_below)
    message(FATAL_ERROR "installed outside of the prefix: ${file}")
  endif()
endforeach()

if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_MAKE_PROGRAM=${BUILD_PROGRAM} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${flags})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/somebodys_robot_client)
run(${WORK}/build/somebodys_robot_client_static)

file(GLOB_RECURSE description ${prefix}/*/ziggurat.pc)
cmake_path(GET description PARENT_PATH folder)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND pkg-config --cflags --libs ziggurat OUTPUT_VARIABLE needed
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(needed UNIX_COMMAND "${needed}")
list(APPEND needed -Wl,-rpath,${prefix}/${LIBRARIES})
run(${COMPILER} -std=c++20 ${flags} ${SOURCE}/main.cpp -o ${WORK}/by_pkg_config ${needed})
run(${WORK}/by_pkg_config)

# The controller of docs/cpp-client.md for its scene, and without a server: it ends with a sentence.
file(READ ${DOCUMENT} document)
string(REGEX MATCH "```cpp\n([^`]*)```" found "${document}")
file(WRITE ${WORK}/my_controller.cpp "${CMAKE_MATCH_1}")
run(${COMPILER} -std=c++20 ${flags} ${WORK}/my_controller.cpp -o ${WORK}/my_controller ${needed})
run(${prefix}/bin/ziggurat run ${SCENES}/dynamics3d_multi_body_test.argos --controller my_controller=${WORK}/my_controller
    --ticks 20 --quiet)
execute_process(COMMAND ${CMAKE_COMMAND} -E env ZIGGURAT_ENDPOINT=nowhere ${WORK}/my_controller
                RESULT_VARIABLE result ERROR_VARIABLE told)
if(NOT result EQUAL 1 OR NOT told MATCHES "^'nowhere': not an endpoint")
  message(FATAL_ERROR "the controller of docs/cpp-client.md without a server: ${result}, ${told}")
endif()

run(${CMAKE_COMMAND} -E chdir ${prefix} bin/ziggurat run ${SCENES}/prototype_radio_test.argos
    --ticks 5 --quiet)
run(${PYTHON} ${prefix}/bin/ziggurat-conformance server --only T2.garbage-text --
    ${prefix}/bin/ziggurat serve {scene} --endpoint {endpoint})
set(ENV{PYTHONPATH} ${prefix}/${PYTHON_PACKAGES})
run(${PYTHON} -c "import ziggurat; assert ziggurat.__file__.startswith('${prefix}'), ziggurat.__file__")
