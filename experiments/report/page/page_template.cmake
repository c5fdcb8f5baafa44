# Puts page.html together with its style and scripts and writes the C++ file that holds it:
#   cmake -D FOLDERS=<folder>,... -D HEADER=<header> -D OUTPUT=<file.cpp> -P page_template.cmake
# page.html is in the first folder. In it, {{ file }} is where that file goes, from the first folder that has it, and
# {{ data }} where the page's data go. The header declares NAME_before_data and NAME_after_data, NAME its own name.

string(REPLACE "," ";" folders "${FOLDERS}")
list(GET folders 0 page_folder)
cmake_path(GET HEADER STEM symbol)
file(READ ${page_folder}/page.html page)
string(REGEX MATCHALL "{{ [^ ]+ }}" places "${page}")
foreach(place IN LISTS places)
  string(REGEX REPLACE "{{ (.+) }}" "\\1" name "${place}")
  if(name STREQUAL "data")
    continue()
  endif()
  unset(file)
  foreach(folder IN LISTS folders)
    if(NOT DEFINED file AND EXISTS ${folder}/${name})
      set(file ${folder}/${name})
    endif()
  endforeach()
  file(READ ${file} text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*|/\\*# sourceMappingURL=[^\n]*" "" text "${text}")
  if(text MATCHES "</script|</style|\\)flinch\"|{{ ")
    message(FATAL_ERROR "${file} cannot be inlined: it contains ${CMAKE_MATCH_0}")
  endif()
  string(REPLACE "${place}" "${text}" page "${page}")
endforeach()

string(REPLACE "{{ data }}" ")flinch\";
const std::string_view ${symbol}_after_data = R\"flinch(" page "${page}")
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace flinch {

const std::string_view ${symbol}_before_data = R\"flinch(${page})flinch\";

}  // namespace flinch
")
