# With CMAKE_UNITY_BUILD (preset `sanitized`) several sources are compiled as one, which halves the
# time: most of it is headers. These stand alone, as names in their anonymous namespaces are also
# those of others.
if(NOT CMAKE_UNITY_BUILD)
  return()
endif()

# stand_alone(target FILES...)
function(stand_alone target)
  if(NOT TARGET ${target})
    return()
  endif()
  get_target_property(folder ${target} SOURCE_DIR)
  list(TRANSFORM ARGN PREPEND ${folder}/)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target}
                              PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

set_target_properties(ziggurat_protocol PROPERTIES UNITY_BUILD OFF)  # generated
stand_alone(ziggurat_scene robots/e_puck.cpp robots/reading.cpp values.cpp)
stand_alone(ziggurat_magnetism adaptive.cpp charges.cpp kernel_avx2.cpp kernel_baseline.cpp)
stand_alone(ziggurat_wire command_driving.cpp)
stand_alone(ziggurat_network barrier_supervision.cpp reception.cpp)
stand_alone(ziggurat_physics welding.cpp)
stand_alone(ziggurat_app inject_option.cpp plot.cpp)
stand_alone(ziggurat_client source/supervisor.cpp)
stand_alone(test_app summary_test.cpp)
stand_alone(test_scene models_test.cpp)
stand_alone(test_physics coming_and_going_test.cpp joint_test.cpp welding_test.cpp contact/pairs_test.cpp contact/reduce_test.cpp)
stand_alone(test_camera agreement_test.cpp)
stand_alone(test_simulation coming_and_going_test.cpp robots_test.cpp)
stand_alone(test_wire driving_test.cpp)
stand_alone(test_network curve_test.cpp delays_test.cpp end_to_end_test.cpp reception_test.cpp)
stand_alone(test_recording readings_test.cpp)
stand_alone(test_client session_cameras_test.cpp)

# Each device has a key of its own in Lua's registry, and all of them are called `key`.
get_target_property(lua_script ziggurat_lua_script SOURCES)
list(FILTER lua_script INCLUDE REGEX "^devices/")
stand_alone(ziggurat_lua_script ${lua_script})
