# cmake -DBUILD_DIR=... -DGENERATOR=... -DCOMPILER=... -DWORK_DIR=... -DSOLVERS_ONLY=... -P run_consumer.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)

# Moved, so that nothing can rely on the place it was installed to.
file(RENAME ${WORK_DIR}/prefix ${WORK_DIR}/moved)

# Nothing internal: no public header names a library that is not the standard's.
file(GLOB_RECURSE headers ${WORK_DIR}/moved/include/*.h)
if(NOT headers)
  message(FATAL_ERROR "no header was installed")
endif()
foreach(header IN LISTS headers)
  file(STRINGS ${header} foreign REGEX "^#include <[^>]*[/.]")
  if(foreign)
    message(FATAL_ERROR "${header} includes a foreign header: ${foreign}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/build -G ${GENERATOR}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved -DSOLVERS_ONLY=${SOLVERS_ONLY})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)

# A component that does not exist is refused, with a message that lists those that do.
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/refused -G ${GENERATOR}
          -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved
          -DSOLVERS_ONLY=${SOLVERS_ONLY} -DEXTRA_COMPONENT=no_such_component
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "component no_such_component is not there; there are: cut, solvers")
  message(FATAL_ERROR "an unknown component was not refused: ${output}")
endif()
