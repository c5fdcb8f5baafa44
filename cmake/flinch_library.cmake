include(GNUInstallDirs)

# flinch_library(<name> FOLDERS <folder>... [PUBLIC <target>...] [PRIVATE <target>...])
#
# The library flinch::<name> of all sources and headers in the folders. Headers are included by their
# path from the root, in the tree and once installed; <flinch/<name>.h> includes all of them. Without a source
# file it is an interface library.
function(flinch_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FOLDERS;PUBLIC;PRIVATE")
  flinch_glob(sources "*.cpp" ${arg_FOLDERS})
  flinch_glob(headers "*.h" ${arg_FOLDERS})

  set(target flinch_${name})
  if(sources)
    add_library(${target} ${sources})
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
    target_compile_definitions(${target} PRIVATE FLINCH_VERSION="${PROJECT_VERSION}")
    target_precompile_headers(${target} REUSE_FROM flinch_precompiled)
    flinch_bundle(${target} 14 ${sources})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC})
    set(scope INTERFACE)
  endif()
  add_library(flinch::${name} ALIAS ${target})

  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target}
    ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/flinch>
    INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM headers REPLACE "^${PROJECT_SOURCE_DIR}/(.*)$" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
  list(JOIN includes "" includes)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/flinch/${name}.h CONTENT "#pragma once\n\n${includes}")
  # That a header needs no other is shown by its own source, which includes it first (tests/house), or else by compiling
  # it alone (all_verify_interface_header_sets).
  set(with_source "")
  set(alone "")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "\\.h$" ".cpp" source ${header})
    if(source IN_LIST sources)
      list(APPEND with_source ${header})
    else()
      list(APPEND alone ${header})
    endif()
  endforeach()
  target_sources(${target} ${scope}
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${with_source}
    FILE_SET headers_alone TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${alone})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON
                                             INTERFACE_HEADER_SETS_TO_VERIFY headers_alone)

  install(TARGETS ${target} EXPORT flinch-targets-${name} COMPONENT development
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flinch COMPONENT development
          FILE_SET headers_alone DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flinch COMPONENT development)
  install(FILES ${PROJECT_BINARY_DIR}/include/flinch/${name}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flinch
          COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY flinch_libraries ${name})
endfunction()

# flinch_glob(<variable> <pattern> <folder>...): the matching files below the folders of the tree.
function(flinch_glob variable pattern)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE patterns)
  list(TRANSFORM patterns APPEND /${pattern})
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
  set(${variable} ${files} PARENT_SCOPE)
endfunction()
