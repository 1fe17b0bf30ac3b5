# Everything a user of the installed package needs: libraries, headers, programs, and with ROS the plugin
# description, launch files, configurations and rviz views.
get_property(donex_programs GLOBAL PROPERTY donex_programs)

if(DONEX_BUILD_ROS)
  install(TARGETS donex_core donex_simulation donex_io donex_evaluation donex_ros donex_simulated_lidar donex_bag_files
      donex_nodelets donex_simulated_lidar_nodelet
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  if(TARGET donex_octomap)
    install(TARGETS donex_octomap donex_octomap_nodelet LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  endif()
  install(TARGETS donex_node donex_simulated_lidar_node ${donex_programs}
    RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
  install(FILES nodelets.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  catkin_install_python(PROGRAMS scripts/donex_archive DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(DIRECTORY workflow DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION} USE_SOURCE_PERMISSIONS)
  install(DIRECTORY config launch report rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
else()
  include(GNUInstallDirs)
  foreach(library donex_core donex_simulation donex_io donex_evaluation)
    if(TARGET ${library})
      install(TARGETS ${library}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    endif()
  endforeach()
  if(donex_programs)
    install(TARGETS ${donex_programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${PROJECT_NAME})
endif()
