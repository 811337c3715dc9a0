# `cmake --install`: libraries, public headers and a package for find_package(CelloCut).
include(CMakePackageConfigHelpers)

# The public headers are these and whatever of ours they include: nothing that a user needs is forgotten,
# nothing internal is shipped.
set(_cellocut_entry_headers solvers/solvers.h solvers/comparison.h cellocut/cut/problem_file.h
  cellocut/cut/problem_statistics.h)
if(NOT CELLOCUT_SOLVERS_ONLY)
  list(APPEND _cellocut_entry_headers
    cellocut/pipeline.h cellocut/base/atomic_file.h cellocut/base/predicates.h
    cellocut/energy/certificate.h cellocut/measure/evaluation.h cellocut/mesh/mesh_file.h
    cellocut/validity/surface_report.h
    cellocut/image/image_evaluation.h cellocut/image/map_pixels.h cellocut/image/png_file.h
    backends/backends.h)
  if(CELLOCUT_WITH_VIZ)
    list(APPEND _cellocut_entry_headers viz/vtp_file.h viz/vtu_file.h viz/section.h)
  endif()
endif()

function(_cellocut_install_headers)
  set(waiting ${ARGN})
  set(installed "")
  while(waiting)
    list(POP_FRONT waiting header)
    if(header IN_LIST installed)
      continue()
    endif()
    list(APPEND installed ${header})
    if(header MATCHES "^cellocut/")
      set(file ${PROJECT_SOURCE_DIR}/lib/${header})
    else()
      set(file ${PROJECT_SOURCE_DIR}/${header})
    endif()
    # A change of its includes is a change of this list.
    set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(STRINGS ${file} includes REGEX "^#include \"")
    foreach(include IN LISTS includes)
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" include "${include}")
      list(APPEND waiting ${include})
    endforeach()
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
  endwhile()
endfunction()
_cellocut_install_headers(${_cellocut_entry_headers})

# Static libraries need, where they are linked, what they were built with.
set(CELLOCUT_COMPONENTS cut solvers)
set(CELLOCUT_DEPENDENCIES Threads)
if(NOT CELLOCUT_SOLVERS_ONLY)
  list(APPEND CELLOCUT_COMPONENTS core image backends)
  list(APPEND CELLOCUT_DEPENDENCIES fmt nlohmann_json CGAL Eigen3 OpenVDB meshoptimizer embree Ceres
    OpenMesh PNG)
  if(CELLOCUT_WITH_DNN)
    list(APPEND CELLOCUT_DEPENDENCIES OpenCVDnn)
  endif()
  if(CELLOCUT_WITH_VIZ)
    list(APPEND CELLOCUT_COMPONENTS viz)
    list(APPEND CELLOCUT_DEPENDENCIES Cairo)
  endif()
endif()
get_property(_cellocut_variant_packages GLOBAL PROPERTY CELLOCUT_VARIANT_PACKAGES)
list(APPEND CELLOCUT_DEPENDENCIES ${_cellocut_variant_packages})
list(REMOVE_DUPLICATES CELLOCUT_DEPENDENCIES)
# The package file finds TBB by itself, before all others.
set(CELLOCUT_NEEDS_TBB OFF)
if(NOT CELLOCUT_SOLVERS_ONLY OR "TBB" IN_LIST CELLOCUT_DEPENDENCIES)
  set(CELLOCUT_NEEDS_TBB ON)
endif()
list(REMOVE_ITEM CELLOCUT_DEPENDENCIES TBB)

set(_cellocut_package ${CMAKE_INSTALL_LIBDIR}/cmake/CelloCut)
string(REPLACE ";" " " CELLOCUT_COMPONENTS_TEXT "${CELLOCUT_COMPONENTS}")
string(REPLACE ";" " " CELLOCUT_DEPENDENCIES_TEXT "${CELLOCUT_DEPENDENCIES}")
configure_package_config_file(cmake/CelloCutConfig.cmake.in
  ${PROJECT_BINARY_DIR}/CelloCutConfig.cmake INSTALL_DESTINATION ${_cellocut_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/CelloCutConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
file(GLOB _cellocut_find_modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/Find*.cmake)
install(FILES ${PROJECT_BINARY_DIR}/CelloCutConfig.cmake
              ${PROJECT_BINARY_DIR}/CelloCutConfigVersion.cmake DESTINATION ${_cellocut_package})
install(FILES ${_cellocut_find_modules} DESTINATION ${_cellocut_package}/modules)
install(EXPORT CelloCutExport NAMESPACE CelloCut:: FILE CelloCutTargets.cmake
        DESTINATION ${_cellocut_package})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cellocut)
