#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "dem/base/files/hdf5_file.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/temporary_folder.h"

namespace granrad::vfgen_test {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

inline Outcome run(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const auto n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

inline Outcome vfgen(const std::string& arguments) {
  return run(std::string(VFGEN) + " " + arguments);
}

class Vfgen : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }
  std::string two_spheres() const {
    return write("two.csv", "x,y,z,radius\n0.002,0.002,0.002,0.0004\n0.0032,0.002,0.002,0.0004\n");
  }
  TemporaryFolder folder_;
};

inline void expect_says(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.text;
  EXPECT_NE(outcome.text.find(part), std::string::npos) << "no '" << part << "' in\n" << outcome.text;
}

/// Version 1 held one variance factor for all pairs, as a dataset.
inline void write_version_1(const fs::path& file) {
  granrad::Hdf5Writer old(file);
  old.attribute("/", "format", std::string("granrad.view_factors"));
  old.attribute("/", "version", std::vector<std::int64_t>{1});
  old.write("/rays/variance_factor", std::vector<double>{1});
  old.commit();
}

}  // namespace granrad::vfgen_test
