# After ParaView is found, where SonoVDB's modules are built and, installed, where a program links them.
# ParaView's package looks for whatever any of its modules was built with. Of the modules that SonoVDB stands on, these
# targets are named in the link interfaces, though neither their headers nor their libraries are asked for by ours: where
# the package did not find them, an empty target spares a user their -dev packages.
foreach(target IN ITEMS Boost::boost GLEW::GLEW LibXml2::LibXml2 MPI::MPI_C NetCDF::NetCDF hdf5::hdf5 hdf5::hdf5_hl)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED)
  endif()
endforeach()
