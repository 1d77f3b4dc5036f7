# pectora_add_plugin(ID SOURCES file... [CORE file...] [LIBRARIES target...])
#
# Builds the plugin ID ("stage.name") as ID.so. CORE are the files that know nothing of plugins: they become a static
# library, ID with "_" for "." and "_core" behind it, which tests link directly. The plugin lies in the folder
# PECTORA_PLUGIN_DIRECTORY, or the present build folder.
function(pectora_add_plugin id)
  cmake_parse_arguments(PLUGIN "" "" "SOURCES;CORE;LIBRARIES" ${ARGN})
  string(REPLACE "." "_" target ${id})
  if(NOT PECTORA_PLUGIN_DIRECTORY)
    set(PECTORA_PLUGIN_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  add_library(${target} MODULE ${PLUGIN_SOURCES})
  if(PLUGIN_CORE)
    add_library(${target}_core STATIC ${PLUGIN_CORE})
    target_link_libraries(${target}_core PUBLIC pectora::kernel ${PLUGIN_LIBRARIES})
    target_link_libraries(${target} PRIVATE ${target}_core)
  endif()
  target_link_libraries(${target} PRIVATE pectora::kernel ${PLUGIN_LIBRARIES})
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${id} LIBRARY_OUTPUT_DIRECTORY "${PECTORA_PLUGIN_DIRECTORY}"
    INSTALL_RPATH "$ORIGIN/..")
  if(PECTORA_INSTALL_PLUGINS)
    install(TARGETS ${target} LIBRARY DESTINATION lib/pectora)
  endif()
  set_property(GLOBAL APPEND PROPERTY PECTORA_PLUGINS ${target})
endfunction()
