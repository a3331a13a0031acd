# Installs the client and the protocol into a fresh prefix, builds the project beside this file
# against it and runs the result. Compiler and generator are those of BUILD: no other need be there.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGV}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
foreach(part protocol clients/cpp)
  run(${CMAKE_COMMAND} --install ${BUILD}/${part} --prefix ${WORK}/prefix --config "${CONFIG}")
endforeach()
if(SANITIZE)
  set(flags "-DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_MAKE_PROGRAM=${BUILD_PROGRAM} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} ${flags})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/somebodys_robot)
