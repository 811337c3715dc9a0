# OpenCV's dnn module. Debian ships OpenCV's CMake config with the whole of OpenCV only (libopencv-dev).
# Defines OpenCVDnn::OpenCVDnn.
find_path(OpenCVDnn_INCLUDE_DIR opencv2/dnn.hpp PATH_SUFFIXES opencv4)
set(_opencv_dnn_libraries "")
foreach(_part IN ITEMS dnn imgproc core)
  find_library(OpenCVDnn_${_part}_LIBRARY opencv_${_part})
  list(APPEND _opencv_dnn_libraries OpenCVDnn_${_part}_LIBRARY)
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVDnn REQUIRED_VARS ${_opencv_dnn_libraries} OpenCVDnn_INCLUDE_DIR)
if(OpenCVDnn_FOUND AND NOT TARGET OpenCVDnn::OpenCVDnn)
  add_library(OpenCVDnn::OpenCVDnn INTERFACE IMPORTED)
  set_target_properties(OpenCVDnn::OpenCVDnn PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${OpenCVDnn_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES
      "${OpenCVDnn_dnn_LIBRARY};${OpenCVDnn_imgproc_LIBRARY};${OpenCVDnn_core_LIBRARY}")
endif()
mark_as_advanced(OpenCVDnn_INCLUDE_DIR ${_opencv_dnn_libraries})
unset(_opencv_dnn_libraries)
