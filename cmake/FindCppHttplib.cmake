# CppHttplib::Server: cpp-httplib as a compiled library, with the definitions that it was compiled with.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_HTTPLIB QUIET cpp-httplib)
endif()
find_path(CppHttplib_INCLUDE_DIR httplib.h HINTS ${PC_HTTPLIB_INCLUDE_DIRS})
find_library(CppHttplib_LIBRARY cpp-httplib HINTS ${PC_HTTPLIB_LIBRARY_DIRS})
mark_as_advanced(CppHttplib_INCLUDE_DIR CppHttplib_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CppHttplib REQUIRED_VARS CppHttplib_LIBRARY CppHttplib_INCLUDE_DIR
                                  VERSION_VAR PC_HTTPLIB_VERSION)

if(CppHttplib_FOUND AND NOT TARGET CppHttplib::Server)
  add_library(CppHttplib::Server INTERFACE IMPORTED)
  set_target_properties(CppHttplib::Server PROPERTIES
    INTERFACE_COMPILE_OPTIONS "${PC_HTTPLIB_CFLAGS_OTHER}"
    INTERFACE_INCLUDE_DIRECTORIES ${CppHttplib_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${CppHttplib_LIBRARY})
endif()
