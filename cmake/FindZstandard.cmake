# Zstandard::zstd: decompresses chunks of bags.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_search_module(PC_ZSTD QUIET libzstd)
endif()
find_path(Zstandard_INCLUDE_DIR zstd.h HINTS ${PC_ZSTD_INCLUDE_DIRS})
find_library(Zstandard_LIBRARY NAMES zstd HINTS ${PC_ZSTD_LIBRARY_DIRS})
mark_as_advanced(Zstandard_INCLUDE_DIR Zstandard_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Zstandard REQUIRED_VARS Zstandard_LIBRARY Zstandard_INCLUDE_DIR)

if(Zstandard_FOUND AND NOT TARGET Zstandard::zstd)
  add_library(Zstandard::zstd UNKNOWN IMPORTED)
  set_target_properties(Zstandard::zstd PROPERTIES
    IMPORTED_LOCATION ${Zstandard_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${Zstandard_INCLUDE_DIR})
endif()
