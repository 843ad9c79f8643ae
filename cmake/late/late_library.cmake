# A start of a program loads and relocates every library that it is linked with. GDAL, and what OpenCV
# needs for files and videos (GDAL again, FFmpeg, GTK), are 210 of 268 libraries and 0.12 of 0.13 s, and
# most runs call none of them. So programs are linked with a stub for each function of these libraries
# that they call: a jump to the function, which the first call of any loads (base/files/late_library.hpp).
#
# The linker names what a list lacks ("undefined reference to `GDALOpen'"): add it to the list as it
# stands between the quotes. A list may hold functions alone. A class whose virtual table a program
# needs, as one derived from a class of the library, cannot come late. Stubs are for x86-64, and
# sanitizers ask for tables of types; other builds are linked as usual.
set(late_default OFF)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"
   AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT CMAKE_CXX_FLAGS MATCHES "sanitize")
  set(late_default ON)
endif()
option(ROADBOOK_LATE_LIBRARIES "Load GDAL and OpenCV's files and videos at their first call" ${late_default})
if(ROADBOOK_LATE_LIBRARIES)
  enable_language(ASM)
endif()

# roadbook_late_library(NAME FILE PACKAGE [LIST]): library roadbook_late_NAME, to be linked in place of
# the shared library FILE of Debian's PACKAGE; LIST, or cmake/late/NAME.txt, lists its functions.
function(roadbook_late_library name file package)
  if(NOT ROADBOOK_LATE_LIBRARIES)
    add_library(roadbook_late_${name} INTERFACE)
    target_link_libraries(roadbook_late_${name} INTERFACE ${file})
    return()
  endif()
  set(folder ${CMAKE_SOURCE_DIR}/cmake/late)
  set(list ${folder}/${name}.txt)
  if(ARGC GREATER 3)
    set(list ${ARGV3})
  endif()
  set(stubs ${CMAKE_BINARY_DIR}/late_${name}.s)
  add_custom_command(OUTPUT ${stubs}
    COMMAND ${folder}/write_stubs.sh ${file} ${package} ${list} > ${stubs}.part
    COMMAND ${CMAKE_COMMAND} -E rename ${stubs}.part ${stubs}
    DEPENDS ${folder}/write_stubs.sh ${list} ${file} VERBATIM)
  add_library(roadbook_late_${name} STATIC ${stubs})
  set_target_properties(roadbook_late_${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(roadbook_late_${name} PUBLIC roadbook_base)
endfunction()
