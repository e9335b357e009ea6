# Sets DESERT_WITH_RVIZ from whether librviz-dev is found: the plugins for rviz.
set(rviz_missing "")
if(DESERT_WITH_RVIZ)
  if(DESERT_WITH_ROS)
    find_package(rviz QUIET)
    if(NOT rviz_FOUND)
      string(APPEND rviz_missing " rviz (librviz-dev or ros-noetic-rviz)")
    else()
      # That of librviz: a process with two versions of Qt has widgets of one and no application of the other.
      string(REGEX MATCH "^[0-9]+" qt "${rviz_QT_VERSION}")
      if(NOT qt)
        set(qt 5)
      endif()
      set(DESERT_QT Qt${qt})
      find_package(${DESERT_QT} QUIET COMPONENTS Widgets Test) # Test: for tests of the panel
      if(NOT ${DESERT_QT}_FOUND)
        string(APPEND rviz_missing " Qt ${rviz_QT_VERSION}, with which rviz is built (qtbase5-dev or qt6-base-dev)")
      endif()
    endif()
  else()
    string(APPEND rviz_missing " ROS")
  endif()
  string(STRIP "${rviz_missing}" rviz_missing)
endif()
desert_decide(RVIZ "${rviz_missing}" "rviz ${rviz_VERSION}, Qt ${${DESERT_QT}_VERSION}")

# desert_use_rviz(<target>): rviz, OGRE and Qt, and the moc for Qt's signals and slots.
function(desert_use_rviz target)
  set_target_properties(${target} PROPERTIES AUTOMOC ON)
  target_compile_definitions(${target} PRIVATE QT_NO_KEYWORDS) # `slots` and `signals` are words of boost, too
  target_include_directories(${target} SYSTEM PUBLIC ${rviz_INCLUDE_DIRS} ${OGRE_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC ${rviz_LIBRARIES} ${DESERT_QT}::Widgets)
  desert_use_ros(${target} ${roscpp_LIBRARIES})
endfunction()
