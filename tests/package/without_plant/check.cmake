# What the program does that was built without the simulation:
#   cmake -D FLINCH=<program> -D RECORDING=<run.h5> -D FOLDER=<for results> -P check.cmake
file(MAKE_DIRECTORY ${FOLDER})
set(scenario apps/scenarios/platform_collision.yaml)
set(needs_plant "without the simulation.*FLINCH_BUILD_PLANT")

# expect(<exit status> <regular expression of what it prints> <argument>...)
function(expect status pattern)
  execute_process(COMMAND ${FLINCH} ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL status OR NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "flinch ${ARGN}: ended with ${result} instead of ${status}, or did not print "
                        "'${pattern}':\n${text}")
  endif()
endfunction()

expect(0 "a good scenario file" check ${scenario})
expect(0 "a good recording file" check ${RECORDING})
expect(0 "digraph" graph ${scenario})
expect(0 "report: " report ${RECORDING} --out ${FOLDER}/report.html)
expect(0 "verdict: good" run ${RECORDING} --station recorded --out ${FOLDER})
expect(2 "${needs_plant}" run ${scenario} --out ${FOLDER}/simulated)
expect(2 "${needs_plant}" serve ${scenario})
# A domain that free_domain() gives to no other test.
expect(2 "nobody sends joint readings" run ${scenario} --station dds --domain 100 --patience 0.2)

execute_process(COMMAND ldd ${FLINCH} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(libraries MATCHES "sundials|Bullet|LinearMath")
  message(FATAL_ERROR "${FLINCH} needs ${CMAKE_MATCH_0}")
endif()
