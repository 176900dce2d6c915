#pragma once
#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "dem/io/snapshot.h"
#include "tests/temporary_folder.h"

namespace granrad {

class ImportFormats : public testing::Test {
 protected:
  Snapshot read(const std::string& text, double radius_m = 0, const std::string& name = "file") const {
    return read_snapshot(folder_.write(name, text), radius_m);
  }
  std::string refusal(const std::string& text, double radius_m = 0) const {
    try {
      read(text, radius_m);
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  }
  static void expect_says(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), text.npos) << text;
  }
  TemporaryFolder folder_;
};

}  // namespace granrad
