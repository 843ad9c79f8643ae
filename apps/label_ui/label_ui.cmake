# The labelling page: TypeScript and OpenLayers, bundled into one C++ source (build.mjs). npm and its
# packages are needed to build the page, never to show it. Without them the program is built without
# the page, and says so.
set(label_ui ${CMAKE_CURRENT_LIST_DIR})
set(label_ui_build ${CMAKE_BINARY_DIR}/label_ui)
set(ROADBOOK_LABEL_PAGE OFF)
find_program(ROADBOOK_NPM npm)
find_program(ROADBOOK_NODE node)
if(ROADBOOK_NPM AND ROADBOOK_NODE)
  foreach(file package.json package-lock.json .npmrc build.mjs tsconfig.json)
    configure_file(${label_ui}/${file} ${label_ui_build}/${file} COPYONLY)
  endforeach()
  # Fetched once for each lock file.
  file(SHA256 ${label_ui}/package-lock.json lock)
  set(stamp ${label_ui_build}/node_modules/installed_${lock})
  if(NOT EXISTS ${stamp})
    message(STATUS "labelling page: npm ci")
    execute_process(COMMAND ${ROADBOOK_NPM} ci WORKING_DIRECTORY ${label_ui_build}
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE reason)
    if(failed)
      message(STATUS "labelling page: npm ci failed: ${reason}")
    else()
      file(TOUCH ${stamp})
    endif()
  endif()
  if(EXISTS ${stamp})
    set(ROADBOOK_LABEL_PAGE ON)
  endif()
endif()

if(ROADBOOK_LABEL_PAGE)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${label_ui}/src/*)
  add_custom_command(
    OUTPUT ${label_ui_build}/page_files.cpp
    COMMAND ${ROADBOOK_NODE} build.mjs ${label_ui} ${label_ui_build}/page_files.cpp
    WORKING_DIRECTORY ${label_ui_build}
    DEPENDS ${sources} ${label_ui}/build.mjs ${label_ui}/package-lock.json
    COMMENT "Bundling the labelling page" VERBATIM)
  target_sources(roadbook_apps PRIVATE ${label_ui_build}/page_files.cpp)
else()
  message(STATUS "labelling page: left out, it needs npm; `roadbook label` then serves no page")
  target_sources(roadbook_apps PRIVATE ${label_ui}/no_page.cpp)
endif()
