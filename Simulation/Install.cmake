# What find_package(SonoVDB) gives to a program: the target sono::Simulation, and headers as <sono/Trace/Trace.h>.

# The stages' headers; those that they include are installed with them, and no others. None may need anything but GLM.
set(public_headers
  Channels/ScenePoints.h
  Core/ParallelFor.h
  Core/Version.h
  DataSets/WriteDataSet.h
  Echo/FormRf.h
  Echo/PointScatterers.h
  Files/DicomCine.h
  Files/DicomMasks.h
  Files/LineCine.h
  Files/ReadTracked.h
  Files/TrackedCine.h
  Image/BMode.h
  Image/GreyMap.h
  Image/LabelSlice.h
  Image/ScanConvert.h
  Image/ScanConvertVolume.h
  Labels/AssignTissues.h
  Labels/BodyFill.h
  Labels/LabelTable.h
  Labels/ReadIntensities.h
  Labels/ReadLabelMap.h
  Link/LiveLink.h
  Phantoms/CalibrationPhantom.h
  Phantoms/PhantomTargets.h
  Phantoms/TestObjects.h
  Phantoms/ThoraxPhantom.h
  Probe/AcousticWindow.h
  Probe/ArrayBeam.h
  Probe/ArrayElements.h
  Probe/HeartLandmarks.h
  Probe/PulseEchoFieldFile.h
  Probe/PulseFile.h
  Probe/StandardViews.h
  Scene/SceneFile.h
  SimulateChannels.h
  Simulator.h
  Trace/CollisionLimit.h
  Trace/ProbeContact.h
  Trace/RecordPaths.h
  Trace/Trace.h)
list(JOIN public_headers "," joined_headers)
set(public_include_dir "${CMAKE_BINARY_DIR}/include")
set(public_header_list "${CMAKE_CURRENT_BINARY_DIR}/PublicHeaders.txt")
add_custom_command(
  OUTPUT "${public_header_list}"
  COMMAND "${CMAKE_COMMAND}"
    "-DHEADERS=${joined_headers}"
    "-DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}"
    "-DINCLUDE=${public_include_dir}"
    "-DLIST=${public_header_list}"
    -P "${CMAKE_CURRENT_SOURCE_DIR}/PublicHeaders.cmake"
  DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/PublicHeaders.cmake"
  DEPFILE "${public_header_list}.d"
  COMMENT "Public headers of Simulation"
  VERBATIM)
add_custom_target(PublicHeaders ALL DEPENDS "${public_header_list}")

# The same headers as pages; a wrong word in a comment fails them.
find_program(DOXYGEN_EXECUTABLE doxygen)
if(DOXYGEN_EXECUTABLE)
  configure_file(Doxyfile.in "${CMAKE_CURRENT_BINARY_DIR}/Doxyfile" @ONLY)
  add_custom_target(docs
    COMMAND "${DOXYGEN_EXECUTABLE}" "${CMAKE_CURRENT_BINARY_DIR}/Doxyfile"
    DEPENDS PublicHeaders
    VERBATIM)
  if(SONOVDB_BUILD_TESTING)
    add_test(NAME Docs.Doxygen COMMAND "${DOXYGEN_EXECUTABLE}" "${CMAKE_CURRENT_BINARY_DIR}/Doxyfile")
    set_tests_properties(Docs.Doxygen PROPERTIES LABELS fast)
  endif()
endif()

target_compile_features(Simulation PUBLIC cxx_std_17)
install(TARGETS Simulation
  EXPORT SonoVDBSimulation
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT simulation
  INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(DIRECTORY "${public_include_dir}/sono" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT simulation)

# The filters' targets, which VTK's module system exports, lie beside it.
include(CMakePackageConfigHelpers)
set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/sonovdb")
install(EXPORT SonoVDBSimulation
  FILE SonoVDBSimulation.cmake
  NAMESPACE sono::
  DESTINATION "${config_dir}"
  COMPONENT simulation)
set(data_dir "${CMAKE_INSTALL_DATADIR}/sonovdb")
set(with_cuda FALSE)
if(CMAKE_CUDA_COMPILER)
  set(with_cuda TRUE)
endif()
configure_package_config_file(SonoVDBConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/SonoVDBConfig.cmake"
  INSTALL_DESTINATION "${config_dir}"
  PATH_VARS data_dir
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/SonoVDBConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(
  FILES "${CMAKE_CURRENT_BINARY_DIR}/SonoVDBConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/SonoVDBConfigVersion.cmake"
  DESTINATION "${config_dir}"
  COMPONENT simulation)
