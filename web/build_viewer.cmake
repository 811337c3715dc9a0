# Makes the C++ source of the 3D view at build time; where that fails, one that says so. Everything that npm
# writes stays in WORK.
#   cmake -DNPM= -DNODE= -DSOURCE= -DWORK= -DOUT= -DREQUIRED= -P build_viewer.cmake
file(REMOVE_RECURSE ${WORK}/src)
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/build.mjs ${SOURCE}/src
     DESTINATION ${WORK})
execute_process(
  COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --no-update-notifier --cache ${WORK}/npm-cache
          --fetch-retries 1 --fetch-timeout 30000
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output TIMEOUT 300)
set(what "npm ci")
if(code EQUAL 0)
  file(REMOVE_RECURSE ${WORK}/npm-cache)
  set(what "the bundler")
  execute_process(COMMAND ${NODE} build.mjs ${OUT} WORKING_DIRECTORY ${WORK}
    RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output TIMEOUT 120)
endif()
if(code EQUAL 0)
  message("${output}")
  return()
endif()
if(REQUIRED)
  file(REMOVE ${OUT})
  message(FATAL_ERROR "CELLOCUT_WEB_VIEWER is ON, and ${what} failed (${code}):\n${output}")
endif()
message("${what} failed (${code}); the program is built without the 3D view:\n${output}")
set(CELLOCUT_VIEWER_NOT_BUILT "${what} failed")
configure_file(${SOURCE}/viewer_absent.cpp.in ${OUT} @ONLY)
file(TOUCH ${OUT})
