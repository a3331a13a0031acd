# SPDX-License-Identifier: MIT
# Runs the unit tests, which decode messages by the real schemas.
file(MAKE_DIRECTORY ${FOLDER})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()
run(${PROTOC} -I${PROTOCOL} --include_imports --descriptor_set_out=${FOLDER}/schemas.bin
    ziggurat/v1/channels.proto foxglove/schemas.proto)
run(${NODE} build.mjs --tests ${FOLDER})
file(GLOB tests ${FOLDER}/*.test.mjs)
run(${CMAKE_COMMAND} -E env ZIGGURAT_SCHEMAS=${FOLDER}/schemas.bin ${NODE} --test ${tests})
