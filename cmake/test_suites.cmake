# One ctest case for each suite of a GoogleTest program. A start of a program loads up to 280 shared
# libraries (0.3 s with OpenCV, GDAL and FFmpeg), so a start for each test would take as long as the
# tests. ctest includes this script (roadbook_test in modules.cmake) when it reads its list of tests.
# Inputs: program, prefix, list_file, properties.
if(NOT EXISTS "${program}")
  add_test("${prefix}NOT_BUILT" "${program}")
  return()
endif()
if("${program}" IS_NEWER_THAN "${list_file}")
  # From a cold disk, a large program may take more than 5 s to list its tests.
  execute_process(COMMAND "${program}" --gtest_list_tests OUTPUT_VARIABLE lines RESULT_VARIABLE status TIMEOUT 300)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} --gtest_list_tests: got status ${status}, want 0")
  endif()
  # Lines of suites start at the margin: "Suite." or "Suite/0.  # TypeParam = int".
  string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." suites "${lines}")
  string(REGEX REPLACE "[\n.]" "" suites "${suites}")
  file(WRITE "${list_file}" "set(suites ${suites})\n")
endif()
include("${list_file}")
foreach(suite ${suites})
  add_test("${prefix}${suite}" "${program}" "--gtest_filter=${suite}.*")
  # Skipped: every test of the suite is, and nothing failed.
  set_tests_properties("${prefix}${suite}" PROPERTIES ${properties}
    SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n\\[  SKIPPED \\] [0-9]+ tests?, listed below:\n(\\[  SKIPPED \\] [^\n]*\n?)+$")
endforeach()
