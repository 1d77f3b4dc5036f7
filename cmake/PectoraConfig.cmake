# find_package(Pectora) gives the target pectora::kernel and the function pectora_add_plugin.
include(${CMAKE_CURRENT_LIST_DIR}/PectoraTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/PectoraPlugin.cmake)
