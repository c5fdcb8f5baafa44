# find_package(flinch COMPONENTS ...): each library is a component that brings its own dependencies.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/flinch)
get_property(libraries GLOBAL PROPERTY flinch_libraries)
set(libraries_of_program ${libraries})
if(TARGET flinch::program)
  list(APPEND libraries program)
endif()
set(default_libraries ${libraries})
list(REMOVE_ITEM default_libraries mechanism_laws)  # which needs GoogleTest
foreach(name IN LISTS libraries)
  install(EXPORT flinch-targets-${name} NAMESPACE flinch:: DESTINATION ${package_dir}
          COMPONENT development)
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/flinch-config.cmake.in flinch-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(flinch-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/flinch-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/flinch-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindHDF5Serial.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindMatio.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindLz4.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindZstandard.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindBulletFloat64.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindCppHttplib.cmake
  DESTINATION ${package_dir} COMPONENT development)
