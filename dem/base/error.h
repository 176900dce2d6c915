#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace granrad {

/// Exit codes of both programs (part of the command-line contract).
enum ExitCode {
  exit_ok = 0,
  exit_numerical_failure = 1,
  exit_bad_input = 2,
  exit_io_failure = 3,
  exit_threshold_missed = 4,
  exit_wall_time = 75,  ///< wall time reached, checkpoint saved
};

/// A problem and what to do about it, as every message says it: "cause; advice".
inline std::string advised(const std::string& cause, const std::string& advice) {
  return cause + "; " + advice;
}

/// Base of every error the programs report; `exit_code` is what the process returns.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exit_code() const { return code_; }

 private:
  ExitCode code_;
};

/// What the user wrote is wrong. Holds every problem found, one per line, each as
/// `file:line:column: what = value (why) what to try`; line and column are left out where a file has none.
class InputError : public Error {
 public:
  explicit InputError(std::vector<std::string> problems)
      : Error(exit_bad_input, join(problems)), problems_(std::move(problems)) {}
  explicit InputError(const std::string& problem) : InputError(std::vector<std::string>{problem}) {}
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  static std::string join(const std::vector<std::string>& lines) {
    std::string all;
    for (const auto& line : lines) all += (all.empty() ? "" : "\n") + line;
    return all;
  }
  std::vector<std::string> problems_;
};

/// A computation has no right result: a NaN, a particle lost, a solver that does not converge, a failed self-check.
class NumericalError : public Error {
 public:
  explicit NumericalError(const std::string& message) : Error(exit_numerical_failure, message) {}
};

/// A file cannot be read or written (missing, full disk, damaged HDF5).
class IoError : public Error {
 public:
  explicit IoError(const std::string& message) : Error(exit_io_failure, message) {}
};

/// A threshold the user asked for was not met.
class ThresholdMissed : public Error {
 public:
  explicit ThresholdMissed(const std::string& message) : Error(exit_threshold_missed, message) {}
};

}  // namespace granrad
