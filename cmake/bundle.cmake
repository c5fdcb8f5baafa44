# flinch_bundle(<target> <largest> <source>...): compiles up to so many sources of a target together.
#
# Most of the time goes into the headers and templates that sources have in common, so those that have no name of their own
# in common stand in one translation unit. Where an edit brings two of one name together, `cmake --preset dev` parts them.
# Groups are named after the target: a source that two of them share is in those of its own folder only. -Wshadow would
# complain of names of different sources, and g++ 12 warns wrongly of use after free in Eigen; clang's preset does without.
find_package(Python3 COMPONENTS Interpreter)
if(NOT Python3_Interpreter_FOUND)
  set(FLINCH_BUNDLE OFF)
endif()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/bundles.py)

function(flinch_bundle target largest)
  if(NOT FLINCH_BUNDLE)
    return()
  endif()
  flinch_bundles(lines ${largest} ${ARGN})
  while(lines)
    list(POP_FRONT lines number file)
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${target}_${number})
  endwhile()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  flinch_warn_as_bundled(${target})
endfunction()

# flinch_bundle_tests(<variable> <target> <largest> <source>...): the sources to make a target of instead of these, which
# are tests. Their names do not matter (bundles.py), so that few of them stand alone; what does is compiled as it is.
function(flinch_bundle_tests variable target largest)
  if(NOT FLINCH_BUNDLE)
    set(${variable} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  flinch_bundles(lines --tests ${largest} ${ARGN})
  set(numbers "")
  while(lines)
    list(POP_FRONT lines number file)
    list(APPEND numbers ${number})
    list(APPEND files_${number} ${file})
  endwhile()
  list(REMOVE_DUPLICATES numbers)
  set(bundles "")
  foreach(number IN LISTS numbers)
    set(bundle ${files_${number}})
    list(LENGTH bundle size)
    if(size GREATER 1)
      set(bundle ${CMAKE_CURRENT_BINARY_DIR}/bundles/${target}_${number}.cpp)
      add_custom_command(OUTPUT ${bundle}
        COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/bundles.py --write ${bundle} ${files_${number}}
        DEPENDS ${files_${number}} ${PROJECT_SOURCE_DIR}/cmake/bundles.py
        VERBATIM)
    endif()
    list(APPEND bundles ${bundle})
  endforeach()
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/bundles)
  set(${variable} ${bundles} PARENT_SCOPE)
endfunction()

# flinch_bundles(<variable> <argument>...): what bundles.py prints, as a list of number, file, number, file...
function(flinch_bundles variable)
  execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/bundles.py ${ARGN}
                  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" lines "${lines}")
  set(${variable} ${lines} PARENT_SCOPE)
endfunction()

# flinch_warn_as_bundled(<target>): nothing of what only bundled sources would bring about.
function(flinch_warn_as_bundled target)
  if(NOT FLINCH_BUNDLE)
    return()
  endif()
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow>
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-use-after-free -Wno-subobject-linkage>)
endfunction()
