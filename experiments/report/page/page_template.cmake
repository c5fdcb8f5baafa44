# Puts page.html together with its style, scripts and dygraphs and writes the C++ file that holds it:
#   cmake -D DYGRAPHS_DIR=<folder of dygraph.min.js> -D OUTPUT=<file.cpp> -P page_template.cmake
# In page.html, {{ file }} is where that file goes and {{ data }} where the report's data goes.

set(page_folder ${CMAKE_CURRENT_LIST_DIR})
file(READ ${page_folder}/page.html page)
string(REGEX MATCHALL "{{ [^ ]+ }}" places "${page}")
foreach(place IN LISTS places)
  string(REGEX REPLACE "{{ (.+) }}" "\\1" name "${place}")
  if(name STREQUAL "data")
    continue()
  endif()
  set(file ${page_folder}/${name})
  if(NOT EXISTS ${file})
    set(file ${DYGRAPHS_DIR}/${name})
  endif()
  file(READ ${file} text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*|/\\*# sourceMappingURL=[^\n]*" "" text "${text}")
  if(text MATCHES "</script|</style|\\)flinch\"|{{ ")
    message(FATAL_ERROR "${file} cannot be inlined: it contains ${CMAKE_MATCH_0}")
  endif()
  string(REPLACE "${place}" "${text}" page "${page}")
endforeach()

string(REPLACE "{{ data }}" ")flinch\";
const std::string_view page_template_after_data = R\"flinch(" page "${page}")
file(WRITE ${OUTPUT} "#include \"experiments/report/page/page_template.h\"

namespace flinch {

const std::string_view page_template_before_data = R\"flinch(${page})flinch\";

}  // namespace flinch
")
