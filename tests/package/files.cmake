# Every file in YAML that is installed is good where it lies: FLINCH, the program; FOLDER, where they are installed. Lists of
# figures are read by 'flinch reproduce' only (tests/experiments/reproduction/paper_figures_test.cpp).
file(GLOB_RECURSE files ${FOLDER}/*.yaml)
list(FILTER files EXCLUDE REGEX "/papers/")
list(LENGTH files count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} files below ${FOLDER}")
endif()
foreach(file IN LISTS files)
  execute_process(COMMAND ${FLINCH} check ${file} --quiet RESULT_VARIABLE status ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    message(SEND_ERROR "${file}: ${said}")
  endif()
endforeach()
