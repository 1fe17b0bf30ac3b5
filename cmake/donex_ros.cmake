# What the ROS layer takes from catkin.
set(DONEX_CATKIN_PACKAGES
  diagnostic_msgs
  diagnostic_updater
  dynamic_reconfigure
  geometry_msgs
  nav_msgs
  nodelet
  pluginlib
  rosbag
  roscpp
  sensor_msgs
  std_msgs
  std_srvs
  tf2
  tf2_eigen
  tf2_ros
  visualization_msgs)
find_package(catkin REQUIRED COMPONENTS ${DONEX_CATKIN_PACKAGES})

file(GLOB donex_cfg CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cfg/*.cfg)
generate_dynamic_reconfigure_options(${donex_cfg})

find_package(Eigen3 REQUIRED NO_MODULE)
get_target_property(EIGEN3_INCLUDE_DIRS Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES donex_ros donex_io donex_simulation donex_core
  CATKIN_DEPENDS ${DONEX_CATKIN_PACKAGES}
  DEPENDS EIGEN3)

# donex_catkin: link this to use the packages above. Their headers are SYSTEM: our warnings are for our code.
add_library(donex_catkin INTERFACE)
target_include_directories(donex_catkin SYSTEM INTERFACE
  ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION}
  ${catkin_INCLUDE_DIRS})
target_link_libraries(donex_catkin INTERFACE ${catkin_LIBRARIES})
if(TARGET pluginlib::pluginlib)
  target_link_libraries(donex_catkin INTERFACE pluginlib::pluginlib)
endif()
if(TARGET ${PROJECT_NAME}_gencfg)
  add_dependencies(donex_catkin ${PROJECT_NAME}_gencfg)
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
