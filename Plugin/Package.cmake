# `cpack` makes two Debian packages: sonovdb (plugin, Python modules, data; ParaView loads it as it starts) and
# libsonovdb-dev (what find_package(SonoVDB) finds).

# ParaView looks for plugins where a file beside its executables says. Of the package alone: elsewhere than in /usr/bin
# nobody would read it.
file(WRITE "${CMAKE_BINARY_DIR}/paraview.conf" "../${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/sonovdb.xml\n")
install(FILES "${CMAKE_BINARY_DIR}/paraview.conf" DESTINATION bin COMPONENT autoload EXCLUDE_FROM_ALL)

# Debian asks for the licence under this name.
install(FILES "${CMAKE_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/sonovdb"
  COMPONENT data RENAME copyright)
install(FILES "${CMAKE_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libsonovdb-dev"
  COMPONENT simulation RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the SonoVDB authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL runtime python data autoload simulation development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT) # NAME_VERSION_ARCHITECTURE.deb, with the architecture that dpkg gives

set(CPACK_DEBIAN_SONOVDB_PACKAGE_NAME sonovdb)
set(CPACK_DEBIAN_SONOVDB_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SONOVDB_DESCRIPTION "Ultrasound images of labelled anatomy, simulated inside ParaView")
set(CPACK_DEBIAN_SONOVDB_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
# The modules' binary interface is one Python's, which dpkg-shlibdeps cannot see.
math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_SONOVDB_PACKAGE_DEPENDS
  "python3-paraview, python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_python})")

set(CPACK_DEBIAN_SONOVDB_PACKAGE_SUGGESTS elastix) # for sonovdb.register_phases

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsonovdb-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Headers and libraries to simulate ultrasound from C++")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "sonovdb (= ${PROJECT_VERSION}), \
libopenvdb-dev, libboost-iostreams-dev, libembree-dev, libtbb-dev, libglm-dev, libnifti-dev, libteem-dev, \
libpugixml-dev, zlib1g-dev, libisal-dev, libdeflate-dev, libdcmtk-dev, libhdf5-dev")
if(SONOVDB_IGTLINK AND IGTLINK_LIBRARY)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libopenigtlink-dev")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS paraview-dev) # for the component Filters

include(CPack)
cpack_add_component_group(sonovdb)
cpack_add_component_group(development)
cpack_add_component(runtime GROUP sonovdb)
cpack_add_component(python GROUP sonovdb)
cpack_add_component(data GROUP sonovdb)
cpack_add_component(autoload GROUP sonovdb)
cpack_add_component(simulation GROUP development)
cpack_add_component(development GROUP development)
