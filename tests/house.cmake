# tests of the house itself
granrad_test(unit/layering granrad_flags)
granrad_test(unit/shortest_numbers granrad_scene)
granrad_test(unit/stated_number granrad_base)
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
# what other programs read
add_test(NAME cli.Exports COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/exports.py ${PROJECT_BINARY_DIR}/bin
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.Exports PROPERTIES LABELS cli TIMEOUT 300)
