# What can be switched, and the flags that every target of the project is compiled with.

option(FLINCH_BUILD_PLANT "Simulated robot (needs SUNDIALS and Bullet)" ON)
option(FLINCH_BUILD_MPI "Campaigns of many programs under mpirun (needs MPI)" ON)
option(FLINCH_BUILD_DRIVERS "Robots on the bus (left out where Cyclone DDS is not found)" ON)
option(FLINCH_BUILD_APPS "The flinch program and the examples" ${PROJECT_IS_TOP_LEVEL})
option(FLINCH_BUILD_TESTS "Tests and benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(FLINCH_BUNDLE "Sources compiled several at a time, which takes half as long (needs Python)" ON)
option(FLINCH_DEVELOPER "Warnings, and errors of them but in a release" ${PROJECT_IS_TOP_LEVEL})
option(FLINCH_ASSERTIONS "assert(), Eigen's and the standard library's checks, in every build type" OFF)
option(FLINCH_FUZZ "Fuzz targets of the readers (needs clang)" OFF)
set(FLINCH_SANITIZE "" CACHE STRING "Sanitizers to compile with, e.g. address,undefined or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  endif()
  # Beside -O3: nobody reads errno after mathematics, nor traps floating-point exceptions.
  set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG -fno-math-errno -fno-trapping-math")
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")

  find_program(FLINCH_CCACHE ccache)
  if(FLINCH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # The sloppiness lets ccache serve files that use a precompiled header.
    set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${FLINCH_CCACHE})
  endif()
endif()

# lld links the tests in a fifth of the time.
find_program(FLINCH_LLD ld.lld)
mark_as_advanced(FLINCH_LLD)
if(FLINCH_LLD AND FLINCH_DEVELOPER)
  add_link_options($<$<NOT:$<CONFIG:Release>>:-fuse-ld=lld>)
endif()

# No contraction into fused multiply-add: results are the same bits whichever compiler built them.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
if(FLINCH_DEVELOPER)
  # No errors in a release: users build it with compilers that warn of other things than ours.
  add_compile_options(-Wall -Wextra -Wconversion -Wshadow $<$<NOT:$<CONFIG:Release>>:-Werror>)
  # g++ 12 takes the unused part of Eigen's bounded matrices for uninitialised values; valgrind and clang know better.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # With -O3 it warns of the insides of strings, vectors and Eigen (PR 105329 and others); -O2 stays strict.
  foreach(warning restrict stringop-overflow stringop-overread array-bounds free-nonheap-object)
    add_compile_options($<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-${warning}>)
  endforeach()
  # Blocks declare what updates their states as members that nobody reads.
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-unused-private-field>)
endif()
if(FLINCH_ASSERTIONS)
  add_compile_options(-UNDEBUG)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
if(FLINCH_SANITIZE)
  add_compile_options(-fsanitize=${FLINCH_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FLINCH_SANITIZE})
endif()
if(FLINCH_FUZZ)  # what was reached is counted everywhere; tests/fuzz links what asks for it
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
