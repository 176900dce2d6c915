#pragma once
#include <fmt/core.h>

#include <string>

namespace granrad::bench {

/// bench [--quick] FOLDER.
struct BenchArguments {
  bool quick = false;
  std::string folder;

  BenchArguments(int argc, char** argv) {
    for (int k = 1; k < argc; ++k)
      if (const std::string word = argv[k]; word == "--quick")
        quick = true;
      else
        folder = word;
    if (folder.empty()) fmt::print(stderr, "usage: {} [--quick] FOLDER\n", argv[0]);
  }
};

}  // namespace granrad::bench
