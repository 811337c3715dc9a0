# Adding a variant is one file and one line:
#   cellocut_add_solver(foo SOURCE foo.cpp [PACKAGE Foo... LINK Foo::foo...])    in solvers/
#   cellocut_add_tetrahedralizer(foo SOURCE foo.cpp [PACKAGE Foo LINK Foo::foo]) in backends/
# The file defines `std::unique_ptr<...> make_foo()` in namespace cellocut::solvers or
# cellocut::backends. Where a PACKAGE or the PROGRAM that it runs is not found, or IF
# names a switch that is off, the variant is listed
# as "not built" with that reason. The tables are generated source: a static object that registers itself
# would be dropped by the linker when it sits in a static library.

function(_cellocut_add_variant kind name)
  cmake_parse_arguments(ARG "" "IF;PROGRAM" "SOURCE;LINK;PACKAGE" ${ARGN})
  set(reason "")
  if(ARG_IF AND NOT ${ARG_IF})
    set(reason "${ARG_IF} is OFF")
  elseif(ARG_PROGRAM)
    find_program(CELLOCUT_${ARG_PROGRAM}_PROGRAM ${ARG_PROGRAM})
    if(NOT CELLOCUT_${ARG_PROGRAM}_PROGRAM)
      set(reason "program ${ARG_PROGRAM} missing")
    endif()
  endif()
  foreach(package IN LISTS ARG_PACKAGE)
    if(package MATCHES "^(TBB|Eigen3)$")  # the modules that OpenVDB and CGAL ship make no targets
      find_package(${package} QUIET CONFIG)
    else()
      find_package(${package} QUIET)
    endif()
    if(NOT reason AND NOT ${package}_FOUND)
      set(reason "${package} missing")
    endif()
  endforeach()
  if(reason)
    message(STATUS "${kind} ${name}: not built: ${reason}")
  else()
    target_sources(cellocut_${kind}s PRIVATE ${ARG_SOURCE})
    if(ARG_LINK)
      target_link_libraries(cellocut_${kind}s PRIVATE ${ARG_LINK})
    endif()
    if(ARG_PACKAGE)
      set_property(GLOBAL APPEND PROPERTY CELLOCUT_VARIANT_PACKAGES ${ARG_PACKAGE})
    endif()
  endif()
  set_property(GLOBAL APPEND PROPERTY CELLOCUT_${kind}_VARIANTS "${name}|${reason}")
endfunction()

# Writes <kind>_table.cpp from all variants that were added and compiles it in.
function(_cellocut_write_table kind header namespace interface)
  get_property(variants GLOBAL PROPERTY CELLOCUT_${kind}_VARIANTS)
  set(CELLOCUT_TABLE_HEADER ${header})
  set(CELLOCUT_TABLE_NAMESPACE ${namespace})
  set(CELLOCUT_TABLE_INTERFACE ${interface})
  set(CELLOCUT_TABLE_DECLARATIONS "")
  set(CELLOCUT_TABLE_ENTRIES "")
  foreach(variant IN LISTS variants)
    string(REGEX MATCH "^([^|]*)\\|(.*)$" _ "${variant}")
    set(name ${CMAKE_MATCH_1})
    set(reason "${CMAKE_MATCH_2}")
    if(reason)
      string(APPEND CELLOCUT_TABLE_ENTRIES "      {\"${name}\", nullptr, \"${reason}\"},\n")
    else()
      string(APPEND CELLOCUT_TABLE_DECLARATIONS "std::unique_ptr<${interface}> make_${name}();\n")
      string(APPEND CELLOCUT_TABLE_ENTRIES "      {\"${name}\", &make_${name}, \"\"},\n")
    endif()
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/variant_table.cpp.in
                 ${CMAKE_CURRENT_BINARY_DIR}/${kind}_table.cpp @ONLY)
  target_sources(cellocut_${kind}s PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${kind}_table.cpp)
endfunction()

macro(cellocut_add_solver name)
  _cellocut_add_variant(solver ${name} ${ARGN})
endmacro()
macro(cellocut_add_tetrahedralizer name)
  _cellocut_add_variant(tetrahedralizer ${name} ${ARGN})
endmacro()
