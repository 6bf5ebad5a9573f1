# The VTK modules, their Python wrapping and the ParaView plugin. Included, not added, by the top CMakeLists.txt, so that
# the modules' folders are relative to it.
find_package(ParaView 5.11 REQUIRED COMPONENTS RemotingViews pqApplicationComponents)
include("${CMAKE_CURRENT_LIST_DIR}/SonoVDBParaViewLinks.cmake")

# The plugin lies three folders below the libraries, lib/python3/dist-packages/sonovdb four below the prefix.
list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/../../.." "$ORIGIN/../../../../${CMAKE_INSTALL_LIBDIR}")

vtk_module_scan(
  MODULE_FILES "${CMAKE_SOURCE_DIR}/Filters/vtk.module" "${CMAKE_SOURCE_DIR}/Plugin/Widgets/vtk.module"
  REQUEST_MODULES SonoVDB::Filters SonoVDB::Widgets
  PROVIDES_MODULES sono_modules
  REQUIRES_MODULES sono_required_modules
  HIDE_MODULES_FROM_CACHE ON)
vtk_module_build(
  MODULES ${sono_modules}
  PACKAGE SonoVDB
  INSTALL_EXPORT SonoVDB
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sonovdb"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/sonovdb")
install(
  FILES "${CMAKE_SOURCE_DIR}/Plugin/SonoVDBFilters.cmake" "${CMAKE_SOURCE_DIR}/Plugin/SonoVDBParaViewLinks.cmake"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/sonovdb"
  COMPONENT development)

set(sono_python_dir "lib/python3/dist-packages")
vtk_module_wrap_python(
  MODULES ${sono_modules}
  TARGET SonoVDB::Python
  PYTHON_PACKAGE sonovdb
  INSTALL_HEADERS OFF # there is one, Python.h of all names, for static modules only
  MODULE_DESTINATION "${sono_python_dir}"
  INSTALL_EXPORT SonoVDB)

# Beside them in the same package what is Python itself.
foreach(file __init__.py datasets.py dlpack.py elastix.py registration.py volume.py)
  configure_file("${CMAKE_CURRENT_LIST_DIR}/python/${file}" "${CMAKE_BINARY_DIR}/${sono_python_dir}/sonovdb/${file}" COPYONLY)
  install(FILES "${CMAKE_CURRENT_LIST_DIR}/python/${file}" DESTINATION "${sono_python_dir}/sonovdb" COMPONENT python)
endforeach()

paraview_plugin_scan(
  PLUGIN_FILES "${CMAKE_SOURCE_DIR}/Plugin/paraview.plugin"
  PROVIDES_PLUGINS sono_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
paraview_plugin_build(
  PLUGINS ${sono_plugins}
  AUTOLOAD ${sono_plugins}
  PLUGINS_COMPONENT runtime
  TARGET_COMPONENT runtime
  PLUGINS_FILE_NAME "sonovdb.xml"
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  DISABLE_XML_DOCUMENTATION OFF)

install(PROGRAMS
  "${CMAKE_SOURCE_DIR}/Plugin/examples/dataset.py"
  "${CMAKE_SOURCE_DIR}/Plugin/examples/plain_vtk.py"
  "${CMAKE_SOURCE_DIR}/Plugin/examples/register_phases.py"
  "${CMAKE_SOURCE_DIR}/Plugin/examples/simulate.py"
  "${CMAKE_SOURCE_DIR}/Plugin/examples/state.py"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/sonovdb/examples"
  COMPONENT data)
