# flinch::mechanism_laws: the laws of all mechanisms as tests of GoogleTest, which a user's program compiles in. It defines
# flinch::test::mechanism_cases() and links GTest::gtest_main.
set(laws ${PROJECT_SOURCE_DIR}/tests/systems/robot)
set(law_sources constrained_bodies dynamics_laws_test mechanism_laws_test random_states)
set(law_headers constrained_bodies differences mechanism_cases mechanism_laws random_states residual)
list(TRANSFORM law_sources REPLACE "(.+)" "${laws}/\\1.cpp" OUTPUT_VARIABLE source_files)
list(TRANSFORM law_headers REPLACE "(.+)" "${laws}/\\1.h" OUTPUT_VARIABLE header_files)
set(installed_laws ${CMAKE_INSTALL_DATADIR}/flinch/mechanism_laws)
list(TRANSFORM law_sources REPLACE "(.+)" "$<INSTALL_INTERFACE:${installed_laws}/\\1.cpp>")

add_library(flinch_mechanism_laws INTERFACE)
target_link_libraries(flinch_mechanism_laws INTERFACE flinch_robot $<INSTALL_INTERFACE:GTest::gtest>)
target_sources(flinch_mechanism_laws INTERFACE ${law_sources})
target_sources(flinch_mechanism_laws INTERFACE
  FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${header_files})
set_target_properties(flinch_mechanism_laws PROPERTIES EXPORT_NAME mechanism_laws)
install(FILES ${source_files} DESTINATION ${installed_laws} COMPONENT development)
install(TARGETS flinch_mechanism_laws EXPORT flinch-targets-mechanism_laws COMPONENT development
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flinch COMPONENT development)
set_property(GLOBAL APPEND PROPERTY flinch_libraries mechanism_laws)
