# Adds the report page, made from the files in this folder and dygraphs, to the sources of a target:
#   add_report_page(<target>)

find_path(DYGRAPHS_DIR dygraph.min.js
  PATHS /usr/share/javascript/dygraphs /usr/share/javascript/dygraphs/dist
  DOC "Folder of dygraph.min.js and dygraph.css (Debian: libjs-dygraphs)"
  NO_DEFAULT_PATH REQUIRED)

set(report_page_folder ${CMAKE_CURRENT_LIST_DIR})

function(add_report_page target)
  file(GLOB parts CONFIGURE_DEPENDS ${report_page_folder}/*.html ${report_page_folder}/*.css
                                    ${report_page_folder}/*.js)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D DYGRAPHS_DIR=${DYGRAPHS_DIR} -D OUTPUT=${output}
            -P ${report_page_folder}/page_template.cmake
    DEPENDS ${parts} ${report_page_folder}/page_template.cmake
            ${DYGRAPHS_DIR}/dygraph.min.js ${DYGRAPHS_DIR}/dygraph.css
    COMMENT "Putting the report page together"
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
