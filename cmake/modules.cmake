add_library(roadbook_flags INTERFACE)
target_compile_options(roadbook_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
                                                -Wold-style-cast)
if(ROADBOOK_WARNINGS_AS_ERRORS)
  target_compile_options(roadbook_flags INTERFACE -Werror)
endif()

# Which of the libraries belong to modules that are not built (ROADBOOK_MODULES).
function(roadbook_missing result)
  set(missing)
  foreach(library ${ARGN})
    string(REGEX REPLACE "^roadbook_" "" module ${library})
    if(NOT TARGET ${library} AND NOT module STREQUAL library AND EXISTS ${CMAKE_SOURCE_DIR}/${module}/CMakeLists.txt)
      list(APPEND missing ${library})
    endif()
  endforeach()
  set(${result} ${missing} PARENT_SCOPE)
endfunction()

# roadbook_module(NAME SOURCES a.cpp b.cpp DEPENDS roadbook_base Eigen3::Eigen ... [JSON: most files read it])
# One module = one folder = one library roadbook_<NAME>; headers beside sources, included from the
# project's root as "NAME/file.hpp".
function(roadbook_module name)
  cmake_parse_arguments(ARG "JSON" "" "SOURCES;DEPENDS" ${ARGN})
  roadbook_missing(missing ${ARG_DEPENDS})
  if(missing)
    message(FATAL_ERROR "ROADBOOK_MODULES: got ${name} without ${missing}, want all modules below it")
  endif()
  add_library(roadbook_${name} STATIC ${ARG_SOURCES})
  roadbook_unity_groups(${ARG_SOURCES})
  target_include_directories(roadbook_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                                                     $<INSTALL_INTERFACE:include/roadbook>)
  target_compile_features(roadbook_${name} PUBLIC cxx_std_20)
  target_link_libraries(roadbook_${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:roadbook_flags>)
  if(ARG_JSON)
    roadbook_precompiled(roadbook_${name} json)
  else()
    roadbook_precompiled(roadbook_${name} plain)
  endif()
endfunction()

# roadbook_test(NAME SOURCES a_test.cpp ... DEPENDS roadbook_x ... [JSON]): one executable test_<NAME>,
# every TEST in it a ctest case. ROADBOOK_DATA points at the real recordings, where there are any.
function(roadbook_test name)
  cmake_parse_arguments(ARG "JSON" "TIMEOUT" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  roadbook_missing(missing ${ARG_DEPENDS})
  if(missing)
    message(STATUS "test_${name} is left out: ${missing} is not built")
    return()
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  roadbook_unity_groups(${ARG_SOURCES})
  target_include_directories(test_${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} roadbook_test_support roadbook_flags
                                             GTest::gtest_main)
  if(ARG_JSON)
    roadbook_precompiled(test_${name} json_tests)
  else()
    roadbook_precompiled(test_${name} tests)
  endif()
  # A test program that is read from a cold disk may take longer to list its tests than the usual 5 s.
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 300
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS ${name})
endfunction()

# roadbook_runs_program(TARGET...): tests that run the program itself.
function(roadbook_runs_program)
  foreach(target ${ARGN})
    add_dependencies(${target} roadbook)
    target_compile_definitions(${target} PRIVATE ROADBOOK_PROGRAM="$<TARGET_FILE:roadbook>"
                                                 ROADBOOK_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  endforeach()
endfunction()
