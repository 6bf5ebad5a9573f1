# The component Filters of find_package(SonoVDB), installed beside what VTK's module system exports.
find_dependency(ParaView 5.11 COMPONENTS RemotingViews) # what the filters' modules link
include("${CMAKE_CURRENT_LIST_DIR}/SonoVDBParaViewLinks.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/SonoVDB-targets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/SonoVDB-vtk-module-properties.cmake")
set(SonoVDB_Filters_FOUND TRUE)
