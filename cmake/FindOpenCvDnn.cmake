# OpenCvDnn::dnn: OpenCV's reader of networks. Debian's libopencv-dnn-dev brings no CMake files.
find_path(OpenCvDnn_INCLUDE_DIR opencv2/dnn.hpp PATH_SUFFIXES opencv4)
find_library(OpenCvDnn_LIBRARY opencv_dnn)
find_library(OpenCvDnn_CORE_LIBRARY opencv_core)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCvDnn
  REQUIRED_VARS OpenCvDnn_LIBRARY OpenCvDnn_CORE_LIBRARY OpenCvDnn_INCLUDE_DIR)
if(OpenCvDnn_FOUND AND NOT TARGET OpenCvDnn::dnn)
  add_library(OpenCvDnn::dnn INTERFACE IMPORTED)
  target_include_directories(OpenCvDnn::dnn SYSTEM INTERFACE ${OpenCvDnn_INCLUDE_DIR})
  target_link_libraries(OpenCvDnn::dnn INTERFACE ${OpenCvDnn_LIBRARY} ${OpenCvDnn_CORE_LIBRARY})
endif()
