# tests of the house itself
granrad_test(unit/layering granrad_flags)
granrad_test(unit/shortest_numbers granrad_scene)
granrad_test(unit/stated_number granrad_base)
granrad_test(unit/remaining_time granrad_base)
# pages in a browser, where there is one
add_test(NAME cli.PagesInBrowser COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/page/pages_in_browser.py
  ${PROJECT_BINARY_DIR}/bin ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.PagesInBrowser PROPERTIES LABELS cli TIMEOUT 600 SKIP_RETURN_CODE 77)
# what README and docs say
add_test(NAME cli.Docs COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/docs/run_docs.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR} $<$<BOOL:${GRANRAD_PYTHON}>:${PROJECT_BINARY_DIR}/python>)
set_tests_properties(cli.Docs PROPERTIES LABELS cli TIMEOUT 600)
# no option is dead, and each is described
add_test(NAME cli.Options COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/options.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.Options PROPERTIES LABELS cli TIMEOUT 600)
# no key of a scene is dead
add_test(NAME cli.SceneKeys COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/scene_keys.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.SceneKeys PROPERTIES LABELS cli TIMEOUT 600)
# what other programs read
add_test(NAME cli.Exports COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/exports.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.Exports PROPERTIES LABELS cli TIMEOUT 300)
# answers to mistyped words
add_test(NAME cli.Manners COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/manners.py ${PROJECT_BINARY_DIR}/bin)
set_tests_properties(cli.Manners PROPERTIES LABELS cli TIMEOUT 300 ENVIRONMENT GRANRAD_DATA=${PROJECT_SOURCE_DIR}/data)
# a project of others that has this one as a folder
add_test(NAME cli.OuterProjectLong COMMAND ${CMAKE_COMMAND} -E env ${CMAKE_CTEST_COMMAND}
  --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/docs/outer_project ${PROJECT_BINARY_DIR}/outer_project
  --build-generator ${CMAKE_GENERATOR} --build-target two_spheres --build-options -DGRANRAD_SOURCE=${PROJECT_SOURCE_DIR}
  -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER} --test-command ${PROJECT_BINARY_DIR}/outer_project/two_spheres)
set_tests_properties(cli.OuterProjectLong PROPERTIES LABELS long TIMEOUT 3000)
# the macro for ParaView, where it is installed
add_test(NAME cli.ParaView COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/paraview.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.ParaView PROPERTIES LABELS cli TIMEOUT 300 SKIP_RETURN_CODE 77)
