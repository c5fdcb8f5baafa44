# Writes the C++ file that holds the style of evaluation pages: that of the report of a run, and what they have besides.
#   cmake -D REPORT_PAGE=<folder of colours.css> -D OUTPUT=<file.cpp> -P style.cmake

set(style "")
foreach(file IN ITEMS ${REPORT_PAGE}/colours.css ${REPORT_PAGE}/page.css ${CMAKE_CURRENT_LIST_DIR}/evaluation.css)
  file(READ ${file} text)
  string(APPEND style "${text}")
endforeach()
if(style MATCHES "</style|\\)flinch\"")
  message(FATAL_ERROR "the style cannot be inlined: it contains ${CMAKE_MATCH_0}")
endif()
file(WRITE ${OUTPUT} "#include \"learning/page/style.h\"

namespace flinch {

const std::string_view evaluation_page_style = R\"flinch(${style})flinch\";

}  // namespace flinch
")
