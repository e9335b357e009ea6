# The files of config/species, climates, rovers and growth_curves become part of desert_core, which then needs to find no folder:
# <folder>_presets.inc has a line {"<name>", R"(<text>)"}, for each.
foreach(folder species climates rovers growth_curves)
  file(GLOB presets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/config/${folder}/*.yaml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${presets})
  set(text "")
  foreach(preset IN LISTS presets)
    get_filename_component(name ${preset} NAME_WE)
    file(READ ${preset} content)
    string(APPEND text "{\"${name}\", R\"yaml(${content})yaml\"},\n")
  endforeach()
  file(GENERATE OUTPUT ${DESERT_GENERATED_DIR}/desert_sim/${folder}_presets.inc CONTENT "${text}")
endforeach()
