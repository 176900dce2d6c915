// The entry of libFuzzer for one kind of file: fuzz_NAME CORPUS... (./do fuzz-files runs all).
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/file_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const auto* const target = [] {
    for (const auto& one : granrad::file_targets())
      if (one.name == GRANRAD_FUZZ_TARGET) return &one;
    std::abort();
  }();
  target->feed({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
