# Adds an HTML page to the sources of a target, made from the page.html of a folder, the style and scripts beside it or
# beside this file, and dygraphs:
#   add_page(<target> <header in that folder, which declares the page>)

find_path(DYGRAPHS_DIR dygraph.min.js
  PATHS /usr/share/javascript/dygraphs /usr/share/javascript/dygraphs/dist
  DOC "Folder of dygraph.min.js and dygraph.css (Debian: libjs-dygraphs)"
  NO_DEFAULT_PATH REQUIRED)

set(report_page_folder ${CMAKE_CURRENT_LIST_DIR})

function(add_page target header)
  cmake_path(GET header PARENT_PATH folder)
  cmake_path(GET header STEM name)
  set(folders ${PROJECT_SOURCE_DIR}/${folder} ${report_page_folder})
  set(parts "")
  foreach(each IN LISTS folders)
    file(GLOB more CONFIGURE_DEPENDS ${each}/*.html ${each}/*.css ${each}/*.js)
    list(APPEND parts ${more})
  endforeach()
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D "FOLDERS=${PROJECT_SOURCE_DIR}/${folder},${report_page_folder},${DYGRAPHS_DIR}"
            -D HEADER=${header} -D OUTPUT=${output} -P ${report_page_folder}/page_template.cmake
    DEPENDS ${parts} ${report_page_folder}/page_template.cmake
            ${DYGRAPHS_DIR}/dygraph.min.js ${DYGRAPHS_DIR}/dygraph.css
    COMMENT "Putting ${folder} together"
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
