#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/scene_text.h"
#include "tests/temporary_folder.h"

namespace granrad::cli {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone afterwards.
struct Scratch : TemporaryFolder {
  fs::path root = path();
};

inline std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal when killed
  std::string out, err;
};

inline int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Runs a program of the build with arguments as a shell would read them.
inline Outcome run(const Scratch& scratch, const std::string& program, const std::string& arguments) {
  const auto out = scratch.root / "stdout.txt", err = scratch.root / "stderr.txt";
  // Waiting threads give up their core: tests share the machine with each other.
  const std::string command = "OMP_WAIT_POLICY=passive " + std::string(GRANRAD_BIN_DIR) + "/" + program +
                              " " + arguments + " >" + out.string() + " 2>" + err.string() + " </dev/null";
  Outcome result;
  result.code = exit_code(std::system(command.c_str()));
  result.out = content(out);
  result.err = content(err);
  return result;
}

inline Outcome granrun(const Scratch& scratch, const std::string& arguments) {
  return run(scratch, "granrun", arguments);
}

/// Starts granrun without waiting; the caller signals and waits for the process number returned.
inline pid_t start_granrun(const std::vector<std::string>& arguments) {
  const pid_t child = fork();
  if (child != 0) return child;
  std::string program = std::string(GRANRAD_BIN_DIR) + "/granrun";
  std::vector<char*> argv{program.data()};
  std::vector<std::string> copies = arguments;
  for (auto& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr)) _exit(126);
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv(program.c_str(), argv.data());
  _exit(127);
}

/// A small plug flow (about 40 particles) that exercises everything: feed, contacts, gas, paths.
inline const std::string small_plug = R"([scene]
name = "small plug"
end_time_s = 0.04
)" + scene_text::alumina + R"([gas]
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
[box]
size_m = [0.004, 0.003, 0.006]
)" + scene_text::hot_across_y + R"([feed]
kind = "plug"
solid_fraction = 0.25
velocity_m_s = 0.1
transverse_velocity_std_m_s = 0.02
seed = 3
[dem]
step_s = 1e-5
[radiation]
source = "paths"
rays = 500
every_s = 0.002
[output]
every_s = 0.004
frames_every_s = 0.008
)";

/// small_plug with one piece of text replaced (every occurrence).
inline std::string edited(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// The last frame of a case.
inline fs::path last_frame(const fs::path& folder) {
  fs::path last;
  for (const auto& entry : fs::directory_iterator(folder / "frames"))
    if (entry.path().extension() == ".hdf" && entry.path() > last) last = entry.path();
  return last;
}

/// Frames are compared byte by byte: the writer puts no clock into them.
inline void expect_same_case(const fs::path& a, const fs::path& b) {
  EXPECT_EQ(last_frame(a).filename(), last_frame(b).filename());
  EXPECT_TRUE(content(last_frame(a)) == content(last_frame(b))) << a << " and " << b << " end differently";
  EXPECT_EQ(content(a / "history.csv"), content(b / "history.csv"));
}

}  // namespace granrad::cli
