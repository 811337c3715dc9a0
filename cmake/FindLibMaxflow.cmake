# Kolmogorov's maxflow library from Debian (libmaxflow-dev): headers below maxflow-3.0 and a shared library,
# no config. Defines LibMaxflow::LibMaxflow.
find_path(LibMaxflow_INCLUDE_DIR maxflow.h PATH_SUFFIXES maxflow-3.0)
find_library(LibMaxflow_LIBRARY NAMES maxflow)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LibMaxflow REQUIRED_VARS LibMaxflow_LIBRARY LibMaxflow_INCLUDE_DIR)
if(LibMaxflow_FOUND AND NOT TARGET LibMaxflow::LibMaxflow)
  add_library(LibMaxflow::LibMaxflow UNKNOWN IMPORTED)
  set_target_properties(LibMaxflow::LibMaxflow PROPERTIES
    IMPORTED_LOCATION ${LibMaxflow_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LibMaxflow_INCLUDE_DIR})
endif()
mark_as_advanced(LibMaxflow_INCLUDE_DIR LibMaxflow_LIBRARY)
