#include "dem/base/program.h"
#include "dem/base/clock.h"

#include <fmt/core.h>
#include <malloc.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/processors.h"

namespace granrad {

namespace {

std::atomic<int> received_signal{0};

void remember_signal(int signal) {
  if (received_signal.exchange(signal) != 0) _exit(128 + signal);
}

std::atomic<bool> checkpoint_wanted{false};

void remember_checkpoint(int) {
  checkpoint_wanted = true;
}

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  const long s = std::lround(seconds);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

const double started_s = monotonic_s();

/// Lines of at most `width` columns, broken at spaces; what goes on is set in by four.
std::string broken(const std::string& text, std::size_t width) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (line.size() > width) {
      const auto at = line.rfind(' ', width);
      if (at == std::string::npos || line.find_first_not_of(' ') >= at) break;  // one long word
      out += line.substr(0, at) + "\n";
      line = std::string(4, ' ').append(line, at + 1);
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace

void print_message(const std::string& text, std::FILE* where) {
  winsize window{};
  constexpr std::size_t narrowest = 20, usual = 80;
  if (isatty(fileno(where)) && ioctl(fileno(where), TIOCGWINSZ, &window) == 0)
    fmt::print(where, "{}", broken(text, window.ws_col > narrowest ? window.ws_col : usual));
  else
    fmt::print(where, "{}\n", text);
}

void keep_freed_memory() {
  constexpr int largest_kept = 32 << 20, kept = 1 << 30;  // bytes; the first is the most it takes
  mallopt(M_MMAP_THRESHOLD, largest_kept);
  mallopt(M_TRIM_THRESHOLD, kept);
}

int run_program(const std::string& name, const std::function<int()>& body) {
  try {
    respect_granted_processors();
    keep_freed_memory();
    const int code = body();
    return interrupt_signal() ? 128 + interrupt_signal() : code;
  } catch (const Error& error) {
    print_message(error.what());
    return interrupt_signal() ? 128 + interrupt_signal() : error.exit_code();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: out of memory\n", name);
    return exit_numerical_failure;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_numerical_failure;
  }
}

void install_signal_handlers() {
  std::signal(SIGINT, remember_signal);
  std::signal(SIGTERM, remember_signal);
  if (std::signal(SIGHUP, remember_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGUSR1, remember_checkpoint);
}

void stop_if_interrupted() {
  if (interrupt_signal()) throw Error(exit_numerical_failure, "stopped by a signal");
}

bool take_checkpoint_request() {
  return checkpoint_wanted.exchange(false);
}

int interrupt_signal() {
  return received_signal;
}

std::string resources_used() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return fmt::format("{:.2f} s of computing on all threads, {:.2f} s by the clock, {:.0f} MB at most",
                     seconds(used.ru_utime) + seconds(used.ru_stime), monotonic_s() - started_s,
                     static_cast<double>(used.ru_maxrss) / 1024);
}

double wall_seconds() {
  return monotonic_s() - started_s;
}

double remaining_seconds(double done_first, double since_first_s, double done, double total) {
  if (!(done > done_first)) return std::numeric_limits<double>::infinity();
  return since_first_s * (total - done) / (done - done_first);
}

Progress::Progress(std::string what, double total, bool quiet)
    : what_(std::move(what)), total_(total), started_s_(monotonic_s()), quiet_(quiet), terminal_(isatty(2)) {
  if (!terminal_) printed_s_ = started_s_ - 20;  // first line after 10 s
}

Progress::~Progress() {
  if (!finished_ && terminal_ && !quiet_ && printed_s_ > 0) fmt::print(stderr, "\n");
}

void Progress::update(double done, const std::string& detail) {
  if (quiet_) return;
  const double now = monotonic_s();
  if (first_s_ < 0) first_done_ = done, first_s_ = now;
  if (now - printed_s_ < (terminal_ ? 0.2 : 30.0)) return;
  printed_s_ = now;
  print(done, detail, false);
}

void Progress::finish(const std::string& detail) {
  if (!quiet_ && !finished_) print(total_, detail, true);
  finished_ = true;
}

void Progress::print(double done, const std::string& detail, bool last) {
  const double elapsed = monotonic_s() - started_s_, part = total_ > 0 ? done / total_ : 1,
               left = remaining_seconds(first_done_, monotonic_s() - first_s_, done, total_);
  std::string line = fmt::format("{} {:5.1f} %", what_, 100 * part);
  if (last)
    line += fmt::format("  in {}", duration_text(elapsed));
  else if (std::isfinite(left))
    line += fmt::format("  ETA {}", duration_text(left));
  if (!detail.empty()) line += "  " + detail;
  if (terminal_)
    fmt::print(stderr, "\r\x1b[K{}{}", line, last ? "\n" : "");
  else
    fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

std::string date_of_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32] = "";
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace granrad
