// Every file that was found hard to read, and simple damage to each, is read or refused: nothing else leaves the
// readers. The long search for more such files is ./do fuzz-files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dem/base/files/text_file.h"
#include "dem/base/random.h"
#include "tests/fuzz/file_targets.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

TEST(FuzzCorpus, IsReadOrRefused) {
  constexpr int damages = 25;
  for (const auto& target : file_targets()) {
    std::size_t files = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(source_dir()) / "tests/fuzz/corpus" / target.name)) {
      const std::string bytes = read_text_file(entry.path());
      ++files;
      EXPECT_NO_THROW(target.feed(bytes)) << entry.path();
      for (int k = 0; k < damages && !bytes.empty(); ++k) {
        std::string damaged = bytes;
        const auto bits = random_bits(17, files, k);
        damaged[bits[0] % damaged.size()] = static_cast<char>(bits[1]);
        if (k % 5 == 0) damaged.resize(bits[1] % damaged.size());
        EXPECT_NO_THROW(target.feed(damaged)) << entry.path() << ", damage " << k;
      }
    }
    EXPECT_GT(files, 0u) << target.name;
  }
}

}  // namespace
}  // namespace granrad
