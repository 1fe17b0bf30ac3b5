# Everything a user of the installed package needs: libraries, headers, programs, and with ROS the plugin
# description, launch files, configurations and rviz views.
include(GNUInstallDirs)

if(DONEX_BUILD_ROS)
  set(donex_lib ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(donex_bin ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(donex_include ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
  set(donex_share ${CATKIN_PACKAGE_SHARE_DESTINATION})
else()
  set(donex_lib ${CMAKE_INSTALL_LIBDIR})
  set(donex_bin ${CMAKE_INSTALL_BINDIR})
  set(donex_include ${CMAKE_INSTALL_INCLUDEDIR}/${PROJECT_NAME})
  set(donex_share ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})
endif()

foreach(library donex_core donex_simulation donex_io donex_ros donex_bag_files donex_nodelets)
  if(TARGET ${library})
    install(TARGETS ${library} ARCHIVE DESTINATION ${donex_lib} LIBRARY DESTINATION ${donex_lib})
  endif()
endforeach()
foreach(program donex_node donex_simulated_lidar_node donex_sequence donex_evaluate donex_simulate donex_bag
    donex_sequence_to_bag)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${donex_bin})
  endif()
endforeach()
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${donex_include} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY config DESTINATION ${donex_share})

if(DONEX_BUILD_ROS)
  install(FILES nodelets.xml DESTINATION ${donex_share})
  install(DIRECTORY launch rviz DESTINATION ${donex_share})
endif()
