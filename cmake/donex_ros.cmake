# What the ROS layer takes from catkin, beside the list of packages in the top-level CMakeLists.txt.

# donex_catkin: link this to use those packages. Their headers are SYSTEM: our warnings are for our code.
add_library(donex_catkin INTERFACE)
#catkin_lint: ignore_once external_interface_path
target_include_directories(donex_catkin SYSTEM INTERFACE ${catkin_INCLUDE_DIRS})
target_link_libraries(donex_catkin INTERFACE ${catkin_LIBRARIES})
if(TARGET pluginlib::pluginlib)
  target_link_libraries(donex_catkin INTERFACE pluginlib::pluginlib)
endif()

if(NOT CATKIN_ENABLE_TESTING)
  set(DONEX_BUILD_TESTS OFF)
endif()

# donex_add_rostest(launch_file [NODE name LIBRARIES libs... SOURCES files...] [DEPENDENCIES targets...]):
# a .test file for rostest, with the GoogleTest program (its own main()) that it starts, if any.
function(donex_add_rostest launch_file)
  cmake_parse_arguments(ARG "" "NODE" "LIBRARIES;SOURCES;DEPENDENCIES" ${ARGN})
  find_package(rostest REQUIRED)
  if(ARG_NODE)
    add_rostest_gtest(${ARG_NODE} ${launch_file} ${ARG_SOURCES})
    donex_test_code(${ARG_NODE} ${ARG_LIBRARIES})
    if(ARG_DEPENDENCIES)
      add_dependencies(${ARG_NODE} ${ARG_DEPENDENCIES})
    endif()
  else()
    add_rostest(${launch_file} DEPENDENCIES ${ARG_DEPENDENCIES})
  endif()
endfunction()
