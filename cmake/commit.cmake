# Writes OUTPUT, the source of apps/flinch/commit.h, for the tree in SOURCE: anew only where the commit is another.
execute_process(COMMAND git describe --always --dirty --exclude=* --abbrev=10
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "")
endif()
set(text "#include \"apps/flinch/commit.h\"\n\nnamespace flinch {\nconst std::string_view commit = \"${commit}\";\n}\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()
