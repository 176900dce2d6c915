# Files that users give: a short run of the corpora with the other tests; with GRANRAD_FUZZ (clang) one program of
# libFuzzer a kind of file, for ./do fuzz-files.
add_library(granrad_file_targets STATIC fuzz/file_targets.cpp)
target_link_libraries(granrad_file_targets PUBLIC granrad_scene granrad_correlation granrad_rays)
granrad_test(fuzz/corpus granrad_file_targets)
if(GRANRAD_FUZZ)
  foreach(kind scene table dump csv stl vtk xyz frame view_factors)
    add_executable(fuzz_${kind} fuzz/fuzz_file.cpp)
    target_link_libraries(fuzz_${kind} PRIVATE granrad_file_targets)
    target_compile_definitions(fuzz_${kind} PRIVATE GRANRAD_FUZZ_TARGET="${kind}")
    target_link_options(fuzz_${kind} PRIVATE -fsanitize=fuzzer)
  endforeach()
endif()
