# Sets DESERT_WITH_RVIZ from whether librviz-dev is found: the plugins for rviz.
set(rviz_missing "")
if(DESERT_WITH_RVIZ)
  if(DESERT_WITH_ROS)
    find_package(rviz QUIET)
    if(NOT rviz_FOUND)
      string(APPEND rviz_missing " rviz (librviz-dev or ros-noetic-rviz)")
    else()
      find_package(Qt5 QUIET COMPONENTS Widgets Test) # Test: for tests of the panel
      if(NOT Qt5_FOUND)
        string(APPEND rviz_missing " Qt5 Widgets (qtbase5-dev)")
      endif()
    endif()
  else()
    string(APPEND rviz_missing " ROS")
  endif()
  string(STRIP "${rviz_missing}" rviz_missing)
endif()
desert_decide(RVIZ "${rviz_missing}" "rviz ${rviz_VERSION}, Qt ${Qt5_VERSION}")

# desert_use_rviz(<target>): rviz, OGRE and Qt, and the moc for Qt's signals and slots.
function(desert_use_rviz target)
  set_target_properties(${target} PROPERTIES AUTOMOC ON)
  target_compile_definitions(${target} PRIVATE QT_NO_KEYWORDS) # `slots` and `signals` are words of boost, too
  target_include_directories(${target} SYSTEM PUBLIC ${rviz_INCLUDE_DIRS} ${OGRE_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC ${rviz_LIBRARIES} Qt5::Widgets)
  desert_use_ros(${target} ${roscpp_LIBRARIES})
endfunction()
