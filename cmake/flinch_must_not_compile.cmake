# flinch_must_not_compile(<file> <library>...)
#
# Misuse that the compiler must refuse. The first line of x.must_not_compile.cpp, "// expect: <regex>", says
# what the compiler must complain about. With FLINCH_CONTROL_CASE defined the same file must compile: it shows
# the right use, and proves that nothing else is wrong with the file.
function(flinch_must_not_compile file)
  file(STRINGS ${file} first_line LIMIT_COUNT 1)
  if(NOT first_line MATCHES "^// expect: (.+)$")
    message(SEND_ERROR "${file}: the first line must be '// expect: <regex>'")
  endif()
  set(diagnostic ${CMAKE_MATCH_1})

  cmake_path(RELATIVE_PATH file OUTPUT_VARIABLE name)
  string(REGEX REPLACE "\\.must_not_compile\\.cpp$" "" name ${name})
  list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_PROPERTY:\\1,INTERFACE_INCLUDE_DIRECTORIES>"
       OUTPUT_VARIABLE folders)
  set(includes "-I$<JOIN:$<REMOVE_DUPLICATES:${folders}>,;-I>")
  set(compile ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only)

  add_test(NAME ${name}/is_refused COMMAND ${compile} "${includes}" ${file} COMMAND_EXPAND_LISTS)
  set_tests_properties(${name}/is_refused PROPERTIES PASS_REGULAR_EXPRESSION "error: .*${diagnostic}")
  add_test(NAME ${name}/control_case_compiles
           COMMAND ${compile} "${includes}" -DFLINCH_CONTROL_CASE ${file} COMMAND_EXPAND_LISTS)
endfunction()
