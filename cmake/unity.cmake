# Compiling several sources as one halves the time, as most of it is headers: the tests are built so
# (ZIGGURAT_UNITY_TESTS), with the preset `sanitized` everything (CMAKE_UNITY_BUILD). The sources
# below stand alone, as names in their anonymous namespaces are also those of others.

# stand_alone(target FILES...): paths from the top of the tree.
function(stand_alone target)
  if(NOT TARGET ${target})
    return()
  endif()
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target}
                              PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

set_target_properties(ziggurat_protocol PROPERTIES UNITY_BUILD OFF)  # generated
set(scene server/scene/robots/e_puck.cpp server/scene/robots/reading.cpp server/scene/values.cpp)
set(magnetism server/magnetism/adaptive.cpp server/magnetism/charges.cpp
    server/magnetism/kernel_avx2.cpp server/magnetism/kernel_baseline.cpp)
set(physics server/physics/welding.cpp)
stand_alone(ziggurat_scene ${scene})
stand_alone(ziggurat_magnetism ${magnetism})
stand_alone(ziggurat_wire server/wire/command_driving.cpp)
stand_alone(ziggurat_physics ${physics})
stand_alone(ziggurat_run server/run/inject_option.cpp)
stand_alone(ziggurat_reports server/reports/plot.cpp)
stand_alone(determinism_probe_other ${scene} ${magnetism} ${physics})
stand_alone(test_reports tests/unit/reports/summary_test.cpp)
stand_alone(test_scene tests/unit/scene/models_test.cpp)
stand_alone(test_physics
  tests/unit/physics/coming_and_going_test.cpp tests/unit/physics/joint_test.cpp
  tests/unit/physics/welding_test.cpp tests/unit/physics/contact/pairs_test.cpp
  tests/unit/physics/contact/reduce_test.cpp)
stand_alone(test_camera tests/unit/camera/agreement_test.cpp)
stand_alone(test_simulation
  tests/unit/simulation/coming_and_going_test.cpp tests/unit/simulation/robots_test.cpp)
stand_alone(test_wire tests/unit/wire/driving_test.cpp)
stand_alone(test_network
  tests/unit/network/curve_test.cpp tests/unit/network/delays_test.cpp
  tests/unit/network/end_to_end_test.cpp tests/unit/network/loading_test.cpp
  tests/unit/network/disturbed_link_test.cpp)
stand_alone(test_recording tests/unit/recording/readings_test.cpp)
stand_alone(test_client tests/unit/clients/session_cameras_test.cpp)
