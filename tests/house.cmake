# tests of the house itself
granrad_test(unit/layering granrad_flags)
granrad_test(unit/shortest_numbers granrad_scene)
# pages in a browser, where there is one
add_test(NAME cli.PagesInBrowser COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/page/pages_in_browser.py
  ${PROJECT_BINARY_DIR}/bin ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.PagesInBrowser PROPERTIES LABELS cli TIMEOUT 600 SKIP_RETURN_CODE 77)
