# FastDDS::FastDDS: another implementation of DDS, which the peer tests let listen to ours. Not by its own
# configuration files: they end the configuration where a dependency of theirs is missing.
find_path(FastDDS_INCLUDE_DIR fastdds/dds/domain/DomainParticipant.hpp)
find_path(FastDDS_CDR_INCLUDE_DIR fastcdr/Cdr.h)
find_library(FastDDS_LIBRARY fastrtps)
find_library(FastDDS_CDR_LIBRARY fastcdr)
mark_as_advanced(FastDDS_INCLUDE_DIR FastDDS_CDR_INCLUDE_DIR FastDDS_LIBRARY FastDDS_CDR_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FastDDS
  REQUIRED_VARS FastDDS_LIBRARY FastDDS_CDR_LIBRARY FastDDS_INCLUDE_DIR FastDDS_CDR_INCLUDE_DIR)

if(FastDDS_FOUND AND NOT TARGET FastDDS::FastDDS)
  add_library(FastDDS::FastDDS UNKNOWN IMPORTED)
  set_target_properties(FastDDS::FastDDS PROPERTIES
    IMPORTED_LOCATION ${FastDDS_LIBRARY}
    INTERFACE_LINK_LIBRARIES ${FastDDS_CDR_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${FastDDS_INCLUDE_DIR};${FastDDS_CDR_INCLUDE_DIR}")
endif()
